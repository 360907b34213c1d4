// Where an estimator's contributions go: the films, and (where somebody looks) strategy layers and
// statistics. One per worker; it also counts what must not pass in silence.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "render/recording.h"

namespace midway {

// Sums of one strategy over all samples, of luminance; exact, so independent of the threads.
struct StrategySums {
    std::uint64_t samples = 0;  // contributions above zero
    Int128 energy = 0;          // weighted by the first exponent
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
    bool statistics = false;
    PixelRect crop;
    Recording recording;
};

// What one worker gathers beside the films.
struct WorkerSums {
    RayCounts rays;
    FixedCounts fixed;
    NonFinite nonfinite;
    std::uint64_t clamped = 0;
    std::vector<StrategySums> strategies;
    std::vector<std::uint64_t> strategy_rays;
};

template <bool observed>
class FilmRecord {
  public:
    FilmRecord(const FilmTargets& targets, WorkerSums& sums) : targets_(targets), sums_(sums) {}
    FilmRecord(const FilmRecord&) = delete;
    FilmRecord& operator=(const FilmRecord&) = delete;
    ~FilmRecord() { add_waiting(); }

    void begin(int x, int y, std::uint64_t pass) {
        x_ = x;
        y_ = y;
        pass_ = pass;
        for (size_t i = 0; i < targets_.films->size(); ++i) {
            pixel_[i] = {};
            prefetch((*targets_.films)[i], x, y);
        }
    }

    bool wants(const Strategy& k) const { return targets_.recording.wants(k); }

    void contribution(const Contribution& c) {
        if (!usable(c)) return;
        for (size_t i = 0; i < targets_.films->size(); ++i) {
            const FixedRgb v = fixed(weighted(c, i));
            for (int k = 0; k < 3; ++k)
                if (__builtin_add_overflow(pixel_[i][k], v[k], &pixel_[i][k]))
                    ++sums_.fixed.overflow;
        }
        if constexpr (observed) observe(c, x_, y_);
    }

    void splat(int x, int y, const Contribution& c) {
        if (!usable(c)) return;
        for (size_t i = 0; i < targets_.films->size(); ++i)
            wait((*targets_.films)[i], x, y, fixed(weighted(c, i)));
        if constexpr (observed) observe(c, x, y);
    }

    // Adds the sample's sum to its pixel.
    void end() {
        for (size_t i = 0; i < targets_.films->size(); ++i)
            add((*targets_.films)[i], x_, y_, pixel_[i]);
    }

  private:
    // A splat on its way to the film.
    struct Waiting {
        Film* film = nullptr;
        int half = 0, x = 0, y = 0;
        FixedRgb value;
    };

    void prefetch(const Film& film, int x, int y) {
        film.prefetch(half(), x - targets_.crop.x0, y - targets_.crop.y0);
    }

    // Splats land anywhere in the film. They wait until the memory they go to has arrived.
    void wait(Film& film, int x, int y, const FixedRgb& value) {
        prefetch(film, x, y);
        waiting_[waiting_count_++] = {&film, half(), x, y, value};
        if (waiting_count_ == waiting_.size()) add_waiting();
    }
    void add_waiting() {
        for (size_t i = 0; i < waiting_count_; ++i) {
            const Waiting& w = waiting_[i];
            add(*w.film, w.half, w.x, w.y, w.value);
        }
        waiting_count_ = 0;
    }

    void add(Film& film, int x, int y, const FixedRgb& value) { add(film, half(), x, y, value); }
    void add(Film& film, int half, int x, int y, const FixedRgb& value) {
        if (!film.add(half, x - targets_.crop.x0, y - targets_.crop.y0, value))
            ++sums_.fixed.overflow;
    }

    int half() const { return static_cast<int>(pass_ & 1); }

    bool usable(const Contribution& c) {
        const bool usable = is_usable(c, targets_.films->size());
        if (!usable) sums_.nonfinite.add(x_, y_, pass_);
        return usable;
    }

    vec3 weighted(const Contribution& c, size_t exponent) {
        const RecordedValue v = recorded_value(targets_.recording, c, exponent);
        sums_.clamped += v.clamped;
        return v.value;
    }

    FixedRgb fixed(const vec3& v) {
        return to_fixed_rgb(v, targets_.films->front().unit_exponent(), sums_.fixed);
    }

    void observe(const Contribution& c, int x, int y) {
        const size_t k = strategy_index(c.strategy);
        const vec3 w = weighted(c, 0);
        if (targets_.statistics) {
            const int unit = targets_.films->front().unit_exponent();
            const float l = luminance(w);
            StrategySums& s = sums_.strategies[k];
            ++s.samples;
            s.energy += to_fixed(l, unit, sums_.fixed);
            // The square of a film's value has its own unit, again 2^-90 of the power's square.
            FixedCounts ignored;
            s.second_moment += to_fixed(l * l, 2 * unit + 90, ignored);
        }
        if (!targets_.layers || k >= targets_.layers->size() || !(*targets_.layers)[k]) return;
        StrategyFilms& films = *(*targets_.layers)[k];
        add(films.weighted, x, y, fixed(w));
        add(films.bare, x, y, fixed(c.value));
    }

    const FilmTargets& targets_;
    WorkerSums& sums_;
    int x_ = 0, y_ = 0;
    std::uint64_t pass_ = 0;
    std::array<FixedRgb, max_exponents> pixel_{};
    std::array<Waiting, 16> waiting_;
    size_t waiting_count_ = 0;
};

}  // namespace midway
