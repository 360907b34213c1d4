// Where an estimator's contributions go: the films, and (where somebody looks) strategy layers, the
// cells of the strategy pyramid, and statistics. One per worker; it also counts what must not pass
// in silence. Whoever looks leaves the films and their counts as they are.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "integrator/estimator_lanes.h"
#include "render/recording.h"
#include "render/strategy_cells.h"

namespace midway {

// Sums of one strategy over all samples, of luminance; exact, so independent of the threads.
struct StrategySums {
    std::uint64_t samples = 0;  // contributions that carry something
    Int128 energy = 0;          // weighted
    Int128 second_moment = 0;   // of the weighted contributions, in units of the film's squared
};

// A pair of films of one strategy: weighted (first exponent) and bare.
struct StrategyFilms {
    Film weighted, bare;
};

// A sample whose contribution was not finite: the one of lowest (pixel, sample) is kept.
struct NonFinite {
    std::uint64_t count = 0;
    int x = 0, y = 0;
    std::uint64_t pass = 0;

    void add(int px, int py, std::uint64_t p) {
        if (count++ == 0 || std::tie(py, px, p) < std::tie(y, x, pass)) {
            x = px;
            y = py;
            pass = p;
        }
    }
    void merge(const NonFinite& o) {
        if (o.count == 0) return;
        const std::uint64_t all = count + o.count;
        if (count == 0 || std::tie(o.y, o.x, o.pass) < std::tie(y, x, pass)) *this = o;
        count = all;
    }
};

// What all workers share.
struct FilmTargets {
    std::vector<Film>* films = nullptr;                             // one per exponent
    std::vector<std::unique_ptr<StrategyFilms>>* layers = nullptr;  // by strategy_index, or null
    StrategyCells* cells = nullptr;                                 // of the pyramid, or null
    bool statistics = false;
    size_t observed_exponent = 0;  // whose weights layers, cells and statistics show
    PixelRect crop;
    Recording recording;
};

// What one worker gathers beside the films.
struct WorkerSums {
    RayCounts rays;
    FixedCounts fixed;
    NonFinite nonfinite;
    std::uint64_t clamped = 0;
    std::uint64_t cells_lost = 0;          // did not fit into a cell of the pyramid
    std::vector<StrategySums> strategies;  // by strategy_index; the last is for all others
    std::vector<std::uint64_t> strategy_rays;
};

template <bool observed>
class FilmRecord {
  public:
    FilmRecord(const FilmTargets& targets, WorkerSums& sums)
        : targets_(targets), sums_(sums), exponents_(targets.films->size()) {}
    FilmRecord(const FilmRecord&) = delete;
    FilmRecord& operator=(const FilmRecord&) = delete;
    ~FilmRecord() {
        add_waiting();
        if constexpr (observed)
            if (targets_.cells) buffer_.flush(*targets_.cells, sums_.cells_lost);
    }

    void begin(int x, int y, std::uint64_t pass) {
        x_ = x;
        y_ = y;
        pass_ = pass;
        for (size_t i = 0; i < exponents_; ++i) {
            pixel_[i] = {};
            prefetch(place_in((*targets_.films)[i], x, y));
        }
        if constexpr (observed)
            if (targets_.cells) buffer_.move_to(*targets_.cells, x, y, sums_.cells_lost);
    }

    bool wants(const Strategy& k) const { return targets_.recording.wants(k); }

    void contribution(const Contribution& c) {
        if (!usable(c)) return;
        for (size_t i = 0; i < exponents_; ++i) {
            const RecordedValue w = weighted(c, i);
            FixedRgb v;
            for (int k = 0; k < 3; ++k) {
                v[k] = recorded_fixed(c, w, k, unit(), sums_.fixed);
                if (__builtin_add_overflow(pixel_[i][k], v[k], &pixel_[i][k]))
                    ++sums_.fixed.overflow;
            }
            if constexpr (observed)
                if (i == targets_.observed_exponent) observe(c, {w.value, v, x_, y_, true});
        }
    }

    void splat(int x, int y, const Contribution& c) {
        if (!usable(c)) return;
        for (size_t i = 0; i < exponents_; ++i) {
            const RecordedValue w = weighted(c, i);
            FixedRgb& v = wait(place_in((*targets_.films)[i], x, y), sums_.fixed.overflow);
            for (int k = 0; k < 3; ++k) v[k] = recorded_fixed(c, w, k, unit(), sums_.fixed);
            if constexpr (observed)
                if (i == targets_.observed_exponent)
                    observe(c, {w.value, FixedRgb(v), x, y, false});
        }
    }

    // Adds the sample's sum to its pixel.
    void end() {
        for (size_t i = 0; i < exponents_; ++i)
            if (pixel_[i] != FixedRgb{}) add((*targets_.films)[i], x_, y_, pixel_[i]);
    }

    // The same for the samples of a whole group, one in each lane; there is one exponent.
    void begin_group(const PixelGroup& g, std::uint64_t pass) {
        pixels_ = g;
        y_ = g.y;
        pass_ = pass;
        group_ = {};
        for (int k = 0; k < g.size(); ++k) prefetch(place_in(targets_.films->front(), g.x(k), g.y));
    }
    void contributions(const FoundLanes& f, int sample) {
        const PlainValues plain = plain_values(f);
        for_each_lane(plain.lanes, [&](int k) {
            const FixedRgb v = fixed(plain.value[k]);
            for (int i = 0; i < 3; ++i)
                if (__builtin_add_overflow(group_[k][i], v[i], &group_[k][i]))
                    ++sums_.fixed.overflow;
        });
        for_each_lane(f.lanes & ~plain.lanes, [&](int k) {
            go_to_lane(k);
            pixel_[0] = group_[k];
            contribution(contribution_of(f, k, sample));
            group_[k] = pixel_[0];
        });
    }
    void splats(const SplatLanes& s) {
        const PlainValues plain = plain_values(s.found);
        for_each_lane(plain.lanes, [&](int k) {
            const SplatPixel& p = s.pixels[k];
            wait(place_in(targets_.films->front(), p.x, p.y), sums_.fixed.overflow) =
                fixed(plain.value[k]);
        });
        for_each_lane(s.found.lanes & ~plain.lanes, [&](int k) {
            x_ = pixels_.x(k);
            splat(s.pixels[k].x, s.pixels[k].y, contribution_of(s.found, k, 0));
        });
    }
    void end_group() {
        for (int k = 0; k < lane_count; ++k)
            if (group_[k] != FixedRgb{}) add(targets_.films->front(), pixels_.x(k), y_, group_[k]);
    }

  private:
    // On its way to a film.
    struct Waiting {
        FilmPlace place;
        std::uint64_t* lost = nullptr;
        FixedRgb value;
    };

    // Weighted values of the lanes that nothing is to be done about but to add them: finite,
    // neither clamped nor so small that recorded_fixed() lifts them, and watched by nobody.
    struct PlainValues {
        Mask8 lanes{};
        Vec3x8 value;
    };
    PlainValues plain_values(const FoundLanes& f) const {
        const Recording& r = targets_.recording;
        PlainValues p;
        if (observed || r.unweighted) return p;
        const Float8 weight = to_float(f.weight), least = all_lanes(0x1p-100f);
        p.value = f.value * weight;
        const auto above = [&](const Float8& v, const Float8& bare) {
            return (v >= least) | (bare == 0);
        };
        p.lanes = f.lanes & is_finite(f.value) & is_finite(weight) & above(p.value.x, f.value.x) &
                  above(p.value.y, f.value.y) & above(p.value.z, f.value.z) &
                  ~(max_component(p.value) > r.clamp);
        return p;
    }

    void go_to_lane(int lane) {
        x_ = pixels_.x(lane);
        if constexpr (observed)
            if (targets_.cells) buffer_.move_to(*targets_.cells, x_, y_, sums_.cells_lost);
    }

    FilmPlace place_in(Film& film, int x, int y) const {
        return film.place(half(), x - targets_.crop.x0, y - targets_.crop.y0);
    }

    // Splats land anywhere in the film. They wait until the memory they go to has arrived. What is
    // returned takes the value: written where it stays, since the processor is slow to copy what it
    // has just written in other pieces.
    FixedRgb& wait(const FilmPlace& place, std::uint64_t& lost) {
        if (waiting_count_ == waiting_.size()) add_waiting();
        prefetch(place);
        Waiting& w = waiting_[waiting_count_++];
        w.place = place;
        w.lost = &lost;
        return w.value;
    }
    void add_waiting() {
        for (size_t i = 0; i < waiting_count_; ++i) {
            const Waiting& w = waiting_[i];
            if (!add_to(w.place, w.value)) ++*w.lost;
        }
        waiting_count_ = 0;
    }

    void add(Film& film, int x, int y, const FixedRgb& value) {
        if (!add_to(place_in(film, x, y), value)) ++sums_.fixed.overflow;
    }

    int half() const { return static_cast<int>(pass_ & 1); }

    bool usable(const Contribution& c) {
        const bool usable = is_usable(c, exponents_);
        if (!usable) sums_.nonfinite.add(x_, y_, pass_);
        return usable;
    }

    RecordedValue weighted(const Contribution& c, size_t exponent) {
        const RecordedValue v = recorded_value(targets_.recording, c, exponent);
        sums_.clamped += v.clamped;
        return v;
    }

    int unit() const { return targets_.films->front().unit_exponent(); }

    FixedRgb fixed(const vec3& v) { return to_fixed_rgb(v, unit(), sums_.fixed); }

    // What the film got, and where.
    struct Added {
        const vec3& weighted;
        const FixedRgb& value;  // the same; not a place in the list of what waits
        int x, y;
        bool own;  // the sample's own pixel
    };

    void observe(const Contribution& c, const Added& a) {
        const size_t k = strategy_index(c.strategy);
        FixedCounts ignored;
        if (targets_.statistics) {
            const float l = luminance(a.weighted);
            StrategySums& s = sums_.strategies[std::min(k, sums_.strategies.size() - 1)];
            ++s.samples;
            s.energy += to_fixed(l, unit(), ignored);
            // The square of a film's value has its own unit, again 2^-90 of the power's square.
            s.second_moment += to_fixed(l * l, 2 * unit() + 90, ignored);
        }
        if (targets_.cells) observe_cell(c, a);
        if (!targets_.layers || k >= targets_.layers->size() || !(*targets_.layers)[k]) return;
        StrategyFilms& films = *(*targets_.layers)[k];
        add(films.weighted, a.x, a.y, a.value);
        add(films.bare, a.x, a.y, fixed(c.value));
    }

    void observe_cell(const Contribution& c, const Added& a) {
        StrategyCells& cells = *targets_.cells;
        const int index = cells.index_of(c.strategy);
        if (index < 0) return;
        StrategyCell& cell = cells.cells[static_cast<size_t>(index)];
        FixedCounts counts;
        const FixedRgb bare = to_fixed_rgb(c.value, unit(), counts);
        sums_.cells_lost += counts.overflow;
        const int px = a.x - cells.crop.x0, py = a.y - cells.crop.y0;
        if (a.own) {
            buffer_.add(index, a.value, bare, sums_.cells_lost);
        } else {
            const int bx = px / cells.box, by = py / cells.box;
            wait(cell.thumbnail.place(0, bx, by), sums_.cells_lost) = a.value;
            wait(cell.thumbnail.place(1, bx, by), sums_.cells_lost) = bare;
        }
        if (!cell.full) return;
        wait(cell.full->place(0, px, py), sums_.cells_lost) = a.value;
        wait(cell.full->place(1, px, py), sums_.cells_lost) = bare;
    }

    const FilmTargets& targets_;
    WorkerSums& sums_;
    const size_t exponents_;
    int x_ = 0, y_ = 0;
    std::uint64_t pass_ = 0;
    std::array<FixedRgb, max_exponents> pixel_{};
    PixelGroup pixels_;  // of a group
    std::array<FixedRgb, lane_count> group_{};
    std::array<Waiting, observed ? 48 : 16> waiting_;
    size_t waiting_count_ = 0;
    struct Nothing {};
    [[no_unique_address]] std::conditional_t<observed, CellBuffer, Nothing> buffer_;
};

}  // namespace midway
