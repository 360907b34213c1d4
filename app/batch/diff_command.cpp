// midway diff: how far an image is from a reference.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "image/metrics.h"
#include "render/json_text.h"
#include "report/comparison.h"
#include "report/reference.h"

namespace midway {
namespace {

struct DiffCommand {
    std::string image, reference;
    std::optional<std::string> mask;
    std::optional<double> epsilon, max_relmse;
    bool json = false;
};

// Of the bias, as far as both images tell their own error; a mask leaves out what is known of it.
double bias_deviate(const DiffCommand& c, const Reference& image, const Reference& reference) {
    return c.mask ? unknown_number : deviate_of_means(image.luminance, reference.luminance);
}

int run(const DiffCommand& c) {
    DiffOptions options;
    options.epsilon = c.epsilon;
    if (c.mask) options.mask = read_image(*c.mask).image;
    const Reference image = load_reference(c.image), reference = load_reference(c.reference);
    const ImageError e = compare_images(image.image, reference.image, options);
    const std::pair<const char*, double> figures[] = {
        {"mse", e.mse},
        {"rmse", e.rmse},
        {"relmse", e.relmse},
        {"relmse_trimmed", e.relmse_trimmed},
        {"smape", e.smape},
        {"flip", e.flip},
        {"mean_ratio", e.mean_ratio},
        {"bias", bias(e)},
        {"bias_z", bias_deviate(c, image, reference)}};
    if (c.json) {
        nlohmann::ordered_json j;
        for (const auto& [key, value] : figures)
            j[key] = std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
        fmt::print("{}\n", json_text(j));
    } else {
        for (const auto& [key, value] : figures)
            fmt::print("{:<15} {}\n", key,
                       std::isnan(value) ? "unknown" : fmt::format("{:.6g}", value));
    }
    if (c.max_relmse && !(e.relmse <= *c.max_relmse)) {
        fmt::print(stderr,
                   "midway: error: relmse {:.6g} exceeds {:.6g} ({}); see the figures above\n",
                   e.relmse, *c.max_relmse, c.image);
        return exit_failed;
    }
    return exit_done;
}

}  // namespace

Command add_diff_command(CLI::App& app) {
    auto c = std::make_shared<DiffCommand>();
    CLI::App& sub = *app.add_subcommand("diff", "Compare an image with a reference");
    sub.add_option("image", c->image, "EXR, HDR or .film")->required();
    sub.add_option("reference", c->reference, "EXR, HDR or .film")->required();
    sub.add_flag("--json", c->json, "Print JSON");
    sub.add_option("--max-relmse", c->max_relmse, "Exit with 1 where relMSE exceeds this");
    sub.add_option("--epsilon", c->epsilon, "relMSE = mean (x-r)^2 / (r^2 + E)");
    sub.add_option("--mask", c->mask, "Image whose non-black pixels count");
    return [c] { return run(*c); };
}

}  // namespace midway
