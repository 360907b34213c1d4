// .film files: the exact sums of a render with all that is needed to go on or to join them
// (settings, scene hash, ranges of passes, program version and instruction set). Format: the line
// "MIDWAYFILM 1", the length of a JSON header (8 bytes, little-endian), the header, for every
// exponent the words of its Film, and a hash of everything before. Everything is checked on
// reading; throws std::runtime_error with one line.
#pragma once

#include <string>
#include <vector>

#include "render/prepare.h"
#include "render/renderer.h"

namespace midway {

struct PassRange {
    std::uint64_t first = 0, end = 0;
    bool operator==(const PassRange&) const = default;
};

struct FilmHeader {
    std::string scene;
    std::string settings;  // settings_json
    std::string version, instruction_set;
    std::uint64_t scene_hash = 0;
    std::vector<PassRange> passes;  // ascending, disjoint
    std::vector<double> exponents;
    int width = 0, height = 0;
    int unit_exponent = 0;
};

struct FilmFile {
    FilmHeader header;
    std::vector<Film> films;  // one per exponent
};

// Everything of the settings that changes the image, as one line of JSON.
std::string settings_json(const RenderSettings& settings);

FilmHeader film_header(const PreparedScene& prepared, const RenderSettings& settings,
                       const ProgressiveRenderer& renderer);

void write_film(const std::string& path, const FilmFile& file);
void write_film(const std::string& path, const FilmHeader& header,
                const ProgressiveRenderer& renderer);
FilmFile read_film(const std::string& path);

// Empty where two films belong to one render, else what tells them apart and what to do.
std::string render_difference(const FilmHeader& a, const FilmHeader& b);

// Throws where two films do not belong to one render.
void check_same_render(const FilmHeader& a, const FilmHeader& b);

// Throws where two films do not belong to one render, or hold the same passes.
void merge_film(FilmFile& into, const FilmFile& from);

PassCounts pass_counts(const FilmHeader& header);

}  // namespace midway
