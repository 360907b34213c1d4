// What the cases of the extreme suite measure: renders of small scenes, means over seeds, and
// comparisons that a correct program fails with a stated chance.
#pragma once

#include "math/statistics.h"
#include "render/renderer.h"
#include "report/extreme.h"

namespace midway::extreme {

// A scene with the view of it and how it is rendered.
struct Setup {
    std::string name;
    SceneDescription scene;
    CameraDescription camera;
    RenderSettings settings;
};

// A square image of `size` pixels through the box filter.
RenderSettings settings(Technique technique, int size, int max_bounces);
std::string label(const RenderSettings& settings);  // "path", "bdpt:1"

// Every kind of light and of surface in one small scene, seen through a lens.
Setup all_kinds(const std::vector<double>& exponents);

std::shared_ptr<const Scene> build(const Setup& setup);

struct Rendered {
    Image image;                // of the first exponent
    std::vector<Image> images;  // of all
    FilmWords film;
    int unit_exponent = 0;
    RenderStatistics statistics;
};

// Throws std::runtime_error where a sample was not finite or did not fit into the film, with what
// --debug-pixel needs to show it.
Rendered render(const Setup& setup, const std::shared_ptr<const Scene>& scene,
                const CaseContext& context, std::uint64_t passes);

double image_mean(const Image& image);  // of all pixels and channels

// The image's mean by independent renders with seeds of their own.
struct Effort {
    std::uint64_t passes = 16;  // per seed; a power of two, times the context's effort
    int seeds = 24;
};
RunningMean mean_over_seeds(const Setup& setup, const CaseContext& context, const Effort& effort);

// The difference of two renders with the same seeds: what they share in noise drops out.
RunningMean difference_over_seeds(const Setup& a, const Setup& b, const CaseContext& context,
                                  const Effort& effort);

// Gathers the comparisons of one case. All of them together fail a correct program with chance
// case_alarm; each must be sharp enough to see a relative difference of `sharpness`.
inline constexpr double case_alarm = 1.5e-5;

class Judge {
  public:
    Judge(const CaseContext& context, int comparisons, double sharpness = 0.02);

    // `model_error` is relative: what the comparison itself leaves out (facets, sizes).
    void equal(const std::string& what, const RunningMean& a, const RunningMean& b,
               double model_error = 0);
    void known(const std::string& what, const RunningMean& a, double expected,
               double model_error = 0);
    // `difference` of two means of about `scale`.
    void zero(const std::string& what, const RunningMean& difference, double scale,
              double model_error = 0);
    // Something that leaves nothing to chance.
    void holds(const std::string& what, bool yes);

    CaseResult result() const;

  private:
    void compare(const std::string& what, double relative, double reach, double model_error);

    double level_, sharpness_;
    int comparisons_, done_ = 0, facts_ = 0;
    double worst_ = -1;  // share of what is allowed
    std::string worst_text_, failures_;
};

// The mean over a setup's view of a function of the place that pixels see on the plane y = 0.
double mean_over_floor(const Setup& setup, const std::function<double(const dvec3&)>& radiance);

}  // namespace midway::extreme
