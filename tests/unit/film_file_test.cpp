// .film files: what is written is read, what is broken is refused with one line, and merging shards
// gives the film of one render.
#include "render/film_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "support/scenes.h"
#include "support/temp_dir.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

using FilmFiles = WorkerMode;
using testing::HasSubstr;
using testing::Not;

FilmFile some_film(std::uint64_t first, std::uint64_t end) {
    FilmFile f;
    f.header.scene = "scene with \"quotes\" and ü.gltf";
    f.header.settings = settings_json(settings(Technique::bdpt, 4));
    f.header.version = "1";
    f.header.instruction_set = "native";
    f.header.scene_hash = 0xfedcba9876543210u;
    f.header.passes = {{first, end}};
    f.header.exponents = {0, 2};
    f.header.width = 5;
    f.header.height = 3;
    f.header.unit_exponent = -88;
    for (size_t i = 0; i < 2; ++i) {
        Film film(5, 3, -88);
        Random random(first * 10 + i);
        // Any low word; high words small enough for a few films to be summed.
        for (size_t k = 0; k < film.words().size(); ++k)
            film.words()[k] = random.below(k % 2 ? ~0ull >> 8 : ~0ull);
        f.films.push_back(film);
    }
    return f;
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

// The message of the error that `act` ends with; it must be one line with a remedy.
std::string error_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
        EXPECT_THAT(e.what(), HasSubstr("; "));
        return e.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

TEST_F(FilmFiles, ReadWhatWasWritten) {
    const TempDir dir;
    const FilmFile written = some_film(0, 7);
    write_film(dir / "a.film", written);
    const FilmFile read = read_film(dir / "a.film");
    EXPECT_EQ(read.header.scene, written.header.scene);
    EXPECT_EQ(read.header.settings, written.header.settings);
    EXPECT_EQ(read.header.version, written.header.version);
    EXPECT_EQ(read.header.instruction_set, written.header.instruction_set);
    EXPECT_EQ(read.header.scene_hash, written.header.scene_hash);
    EXPECT_EQ(read.header.passes, written.header.passes);
    EXPECT_EQ(read.header.exponents, written.header.exponents);
    EXPECT_EQ(read.header.unit_exponent, -88);
    ASSERT_EQ(read.films.size(), 2u);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(read.films[i].words(), written.films[i].words());
}

TEST_F(FilmFiles, EveryTruncationIsRefused) {
    const TempDir dir;
    write_film(dir / "a.film", some_film(0, 7));
    const std::string whole = bytes_of(dir / "a.film");
    for (size_t n = 0; n < whole.size(); n += n < 40 || n + 20 > whole.size() ? 1 : 97) {
        write_bytes(dir / "b.film", whole.substr(0, n));
        error_of([&] { read_film(dir / "b.film"); });
    }
}

TEST_F(FilmFiles, EveryFlippedByteIsRefused) {
    const TempDir dir;
    write_film(dir / "a.film", some_film(0, 7));
    const std::string whole = bytes_of(dir / "a.film");
    for (size_t n = 0; n < whole.size(); n += n < 600 ? 1 : 131) {
        SCOPED_TRACE(n);
        std::string broken = whole;
        broken[n] = static_cast<char>(broken[n] ^ 0x21);
        write_bytes(dir / "b.film", broken);
        error_of([&] { read_film(dir / "b.film"); });
    }
}

TEST_F(FilmFiles, HugeClaimsTakeNoMemory) {
    const TempDir dir;
    const std::string magic = "MIDWAYFILM 1\n";
    const auto with_header = [&](const std::string& header) {
        std::uint64_t length = header.size();
        std::string bytes = magic;
        bytes.append(reinterpret_cast<const char*>(&length), 8);
        write_bytes(dir / "b.film", bytes + header);
        return error_of([&] { read_film(dir / "b.film"); });
    };
    write_bytes(dir / "b.film", magic + std::string(8, '\xff'));
    error_of([&] { read_film(dir / "b.film"); });
    const std::string rest = R"("scene":"","scene_hash":1,"settings":"","version":"",)"
                             R"("instruction_set":"","exponents":[2],"unit_exponent":-90,)";
    with_header("{" + rest + R"("passes":[[0,1]],"width":65536,"height":65536})");
    with_header("{" + rest + R"("passes":[[0,1]],"width":-1,"height":4})");
    with_header("{" + rest + R"("passes":[[0,1]],"width":16000,"height":16000})");
    with_header("{" + rest + R"("passes":[[1,1]],"width":4,"height":4})");
    with_header("{" + rest + R"("passes":[[2,3],[0,1]],"width":4,"height":4})");
    with_header("{" + rest + R"("passes":[[0]],"width":4,"height":4})");
    with_header("[[[[[[[[");
    EXPECT_THAT(error_of([&] { read_film(dir / "absent.film"); }), HasSubstr("absent.film"));
}

TEST_F(FilmFiles, ShardsMergeToTheFilmOfOneRender) {
    SceneDescription d;
    add(d, make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), lambert(vec3(0.5f)));
    d.sky = constant_sky(vec3(1));
    const auto scene = build(d);
    const auto camera = camera_at({0, 1, 2}, vec3(0), 0.6);
    const auto rendered = [&](std::uint64_t passes) {
        ProgressiveRenderer r(scene, camera, settings(Technique::bdpt, 4), {.threads = 1});
        r.render_passes(passes);
        FilmFile f;
        f.header.passes = {{0, passes}};
        f.films.push_back(r.film());
        return f;
    };
    // Two films of the same passes are one too many.
    FilmFile again = rendered(3);
    EXPECT_THAT(error_of([&] { merge_film(again, rendered(2)); }), HasSubstr("same samples"));
    // Films of other passes add their sums and ranges.
    FilmFile a = some_film(0, 3), b = some_film(5, 6), c = some_film(3, 5);
    FilmFile left = a, right = c;
    merge_film(left, b);
    merge_film(left, c);
    merge_film(right, b);
    merge_film(right, a);
    EXPECT_EQ(left.header.passes, right.header.passes);
    EXPECT_EQ(pass_counts(left.header).total(), 6u);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(left.films[i].words(), right.films[i].words());
}

TEST_F(FilmFiles, SumsThatLeaveTheirRangeDoNotMerge) {
    FilmFile a = some_film(0, 1), b = some_film(1, 2);
    a.films[1].words()[7] = b.films[1].words()[7] = ~0ull >> 1;
    EXPECT_THAT(error_of([&] { merge_film(a, b); }), HasSubstr("leaves its range"));
}

TEST_F(FilmFiles, FilmsOfDifferentRendersDoNotMerge) {
    const std::function<void(FilmHeader&)> changes[] = {[](FilmHeader& h) { h.scene_hash ^= 1; },
                                                        [](FilmHeader& h) { h.settings += " "; },
                                                        [](FilmHeader& h) { h.exponents[0] = 1; },
                                                        [](FilmHeader& h) { h.unit_exponent = 0; },
                                                        [](FilmHeader& h) { h.version = "2"; },
                                                        [](FilmHeader& h) { h.instruction_set = "other"; }};
    for (const auto& change : changes) {
        FilmFile into = some_film(0, 1), from = some_film(1, 2);
        change(from.header);
        error_of([&] { merge_film(into, from); });
    }
}

}  // namespace
}  // namespace midway::test
