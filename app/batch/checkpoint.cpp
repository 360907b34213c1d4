#include "checkpoint.h"

#include <filesystem>
#include <stdexcept>

#include "render/film_file.h"

namespace midway {

void Checkpoint::resume(ProgressiveRenderer& r) const {
    if (!options_.resume || !std::filesystem::exists(*options_.path)) return;
    FilmFile film = read_film(*options_.path);
    check_same_render(film_header(prepared_, settings_, r), film.header);
    const std::vector<PassRange>& passes = film.header.passes;
    if (passes.size() != 1 || passes.front().first != r.first_pass())
        throw std::runtime_error("checkpoint holds other samples (" + *options_.path +
                                 "); give the same --shard");
    r.adopt(std::move(film.films), passes.front().end - passes.front().first);
}

void Checkpoint::write_if_due(const ProgressiveRenderer& r) {
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - last_).count() < options_.every_seconds) return;
    write(r);
}

void Checkpoint::write(const ProgressiveRenderer& r) {
    if (!options_.path) return;
    write_film(*options_.path, film_header(prepared_, settings_, r), r);
    last_ = std::chrono::steady_clock::now();
}

}  // namespace midway
