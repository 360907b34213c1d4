// What the audit measures on each path that a sample draws, summed so that the order of paths does
// not show: one PathAudit per worker.
#pragma once

#include <vector>

#include "image/film.h"
#include "report/audit.h"
#include "report/drawn_path.h"

namespace midway {

// Distribution of the samples' luminance: exact sums in 16 steps per octave.
class BrightnessHistogram {
  public:
    explicit BrightnessHistogram(int unit_exponent) : unit_(unit_exponent), bins_(bin_count) {}
    void add(float luminance);
    void merge(const BrightnessHistogram& other);
    // Share of the whole held by the brightest of `samples` samples (those that carry nothing
    // included).
    double share_of_brightest(double part, std::uint64_t samples) const;
    double total() const;

  private:
    struct Bin {
        std::uint64_t count = 0;
        Int128 sum = 0;
    };
    static constexpr int steps = 16, lowest = -150, bin_count = 300 * steps;
    int unit_;
    std::vector<Bin> bins_;
};

struct PathAudit {
    PathAudit(const Estimator& estimator, int unit_exponent, bool float_recursion);

    // Draws the paths of one sample and measures them.
    void add_sample(const Estimator& e, const PathSetting& setting, int x, int y,
                    std::uint64_t pass);
    void merge(const PathAudit& other);
    std::uint64_t paths() const { return paths_; }
    void report(AuditResult& result) const;

  private:
    void add_path(const Estimator& e, const PathSetting& setting, const DrawnPath& path,
                  const AuditPlace& place);
    void add_contribution(const Estimator& e, const DrawnPath& path, const AuditPlace& place);
    void add_same_pdfs(const PathSetting& setting, const DrawnPath& path, AuditPlace place);
    void add_own_pdfs(const Estimator& e, const PathSetting& setting, const DrawnPath& path,
                      AuditPlace place);
    void add_ranges(const DrawnPath& path);
    Int128 fixed(float value);
    double square_scale() const;  // what squares are divided by, to fit the film's range

    struct Weights {
        Deviation recursive, same_sum, estimator, own_sum;
        Int128 energy = 0, bias = 0, bias_squares = 0;
        Range partial_sums;
    };
    std::array<Weights, audited_exponents.size()> weights_;
    std::vector<std::uint64_t> drawn_;  // by strategy_index
    std::uint64_t paths_ = 0, samples_ = 0;
    int longest_ = 0;
    Range pdf_w_, pdf_a_;
    int unit_;
    BrightnessHistogram brightness_;
    float sample_luminance_ = 0, largest_ = 0;
    AuditPlace largest_place_, nonfinite_place_;
    std::uint64_t nonfinite_ = 0;
    FixedCounts film_;  // what the film would do to the contributions
    bool float_recursion_;
    FloatRecursion float_;
};

}  // namespace midway
