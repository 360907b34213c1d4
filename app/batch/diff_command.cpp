// midway diff: how far an image is from a reference.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "image/metrics.h"

namespace midway {
namespace {

struct DiffCommand {
    std::string image, reference;
    std::optional<std::string> mask;
    std::optional<double> epsilon, max_relmse;
    bool json = false;
};

int run(const DiffCommand& c) {
    DiffOptions options;
    options.epsilon = c.epsilon;
    if (c.mask) options.mask = read_image(*c.mask).image;
    const ImageError e =
        compare_images(read_image(c.image).image, read_image(c.reference).image, options);
    const std::pair<const char*, double> figures[] = {{"mse", e.mse},
                                                      {"rmse", e.rmse},
                                                      {"relmse", e.relmse},
                                                      {"relmse_trimmed", e.relmse_trimmed},
                                                      {"smape", e.smape},
                                                      {"flip", e.flip},
                                                      {"mean_ratio", e.mean_ratio}};
    if (c.json) {
        nlohmann::ordered_json j;
        for (const auto& [key, value] : figures) j[key] = value;
        fmt::print("{}\n", j.dump(2));
    } else {
        for (const auto& [key, value] : figures) fmt::print("{:<15} {:.6g}\n", key, value);
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
    sub.add_option("image", c->image, "EXR or HDR")->required();
    sub.add_option("reference", c->reference, "EXR or HDR")->required();
    sub.add_flag("--json", c->json, "Print JSON");
    sub.add_option("--max-relmse", c->max_relmse, "Exit with 1 where relMSE exceeds this");
    sub.add_option("--epsilon", c->epsilon, "relMSE = mean (x-r)^2 / (r^2 + E)");
    sub.add_option("--mask", c->mask, "Image whose non-black pixels count");
    return [c] { return run(*c); };
}

}  // namespace midway
