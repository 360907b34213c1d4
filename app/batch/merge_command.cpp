// midway merge: films of one render, made apart, become one film or image with the very bits that a
// single run would have made.
#include <filesystem>

#include "commands.h"
#include "image/png.h"
#include "outputs.h"
#include "render/film_file.h"

namespace midway {
namespace {

struct MergeCommand {
    std::vector<std::string> films;
    OutputOptions outputs;
};

Metadata film_metadata(const FilmHeader& h) {
    return {{"midway:version", h.version},
            {"midway:scene", h.scene},
            {"midway:scene_hash", hex_hash(h.scene_hash)},
            {"midway:settings", h.settings},
            {"midway:spp", std::to_string(pass_counts(h).total())}};
}

int run(const MergeCommand& c) {
    check_outputs(c.outputs);
    FilmFile all = read_film(c.films.front());
    for (size_t i = 1; i < c.films.size(); ++i) merge_film(all, read_film(c.films[i]));
    for (const std::string& path : c.outputs.images) {
        if (std::filesystem::path(path).extension() == ".film") {
            write_film(path, all);
            continue;
        }
        for (size_t i = 0; i < all.films.size(); ++i)
            write_image(path, c.outputs, resolve(all.films[i], pass_counts(all.header)),
                        all.header.exponents, i, film_metadata(all.header));
    }
    return exit_done;
}

}  // namespace

Command add_merge_command(CLI::App& app) {
    auto c = std::make_shared<MergeCommand>();
    CLI::App& sub = *app.add_subcommand("merge", "Join films of one render");
    sub.add_option("films", c->films, "Films (.film)")->required();
    sub.add_option("-o,--output", c->outputs.images, ".exr, .png or .film (repeatable)")
        ->required()
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    sub.add_option("--exposure", c->outputs.exposure, "EV of PNG files, or auto");
    return [c] { return run(*c); };
}

}  // namespace midway
