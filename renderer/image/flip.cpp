#include "image/flip.h"

#include <array>

namespace midway {
namespace {

constexpr double pi_d = 3.14159265358979323846;

struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;

    Plane(int w, int h) : width(w), height(h), values(static_cast<size_t>(w) * h) {}
    float* row(int y) { return values.data() + static_cast<size_t>(y) * width; }
    const float* row(int y) const { return values.data() + static_cast<size_t>(y) * width; }
};

using Kernel = std::vector<double>;  // 2 * radius + 1 taps

// Linear sRGB to XYZ, from the primaries and the D65 white of IEC 61966-2-1, in rows.
constexpr double xyz_rows[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

dmat3 xyz_from_rgb() {
    dmat3 m;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) m[column][row] = xyz_rows[row][column];
    return m;
}

// Rows that give XYZ over the white point's.
dmat3 relative_xyz_from_rgb() {
    dmat3 m = xyz_from_rgb();
    const dvec3 white = m * dvec3(1);
    for (int column = 0; column < 3; ++column) m[column] /= white;
    return m;
}

// The linear opponent space of section 4.1.1.
dvec3 ycxcz_from_relative_xyz(const dvec3& v) {
    return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}

dvec3 relative_xyz_from_ycxcz(const dvec3& v) {
    const double y = (v.x + 16) / 116;
    return {y + v.y / 500, y, y - v.z / 200};
}

// L*a*b* with a* and b* scaled by 0.01 L* (Hunt effect), section 4.1.2.
dvec3 hunt_lab_from_relative_xyz(const dvec3& v) {
    constexpr double delta = 6.0 / 29;
    dvec3 f;
    for (int i = 0; i < 3; ++i)
        f[i] =
            v[i] > delta * delta * delta ? std::cbrt(v[i]) : v[i] / (3 * delta * delta) + 4.0 / 29;
    const double lightness = 116 * f.y - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

double hyab(const dvec3& a, const dvec3& b) {
    const dvec3 d = a - b;
    return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

Kernel gaussian(int radius, double inverse_two_variance) {
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i)
        kernel.push_back(std::exp(-inverse_two_variance * i * i));
    return kernel;
}

double sum(const Kernel& kernel) {
    double total = 0;
    for (double k : kernel) total += k;
    return total;
}

void scale(Kernel& kernel, double factor) {
    for (double& k : kernel) k *= factor;
}

// Scales the positive taps to a sum of 1 and the negative ones to -1.
void balance(Kernel& kernel) {
    double positive = 0, negative = 0;
    for (double k : kernel) (k > 0 ? positive : negative) += k;
    for (double& k : kernel) k /= k > 0 ? positive : -negative;
}

// Convolution along rows, then along columns; the border's pixels go on outside.
Plane filter(const Plane& in, const Kernel& along_rows, const Kernel& along_columns) {
    const int radius = static_cast<int>(along_rows.size() / 2);
    Plane middle(in.width, in.height), out(in.width, in.height);
    std::vector<float> padded(static_cast<size_t>(in.width) + 2 * radius);
    std::vector<double> sums(in.width);
    for (int y = 0; y < in.height; ++y) {
        for (int x = -radius; x < in.width + radius; ++x)
            padded[x + radius] = in.row(y)[std::clamp(x, 0, in.width - 1)];
        std::fill(sums.begin(), sums.end(), 0.0);
        for (int k = 0; k <= 2 * radius; ++k)
            for (int x = 0; x < in.width; ++x) sums[x] += along_rows[k] * padded[x + k];
        std::copy(sums.begin(), sums.end(), middle.row(y));
    }
    for (int y = 0; y < in.height; ++y) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (int k = 0; k <= 2 * radius; ++k) {
            const float* row = middle.row(std::clamp(y + k - radius, 0, in.height - 1));
            for (int x = 0; x < in.width; ++x) sums[x] += along_columns[k] * row[x];
        }
        std::copy(sums.begin(), sums.end(), out.row(y));
    }
    return out;
}

// One Gaussian of a contrast sensitivity function, in degrees: a sqrt(pi / b) exp(-pi^2 x^2 / b).
struct Sensitivity {
    double a, b;
};

// Blurs as the eye does (table 1). A Gaussian in two dimensions is a product of two, a sum of
// Gaussians is not, so each goes by itself; together they have weight one.
Plane sensitivity_filter(const Plane& in, std::initializer_list<Sensitivity> gaussians,
                         double pixels_per_degree) {
    // Three standard deviations of the widest Gaussian of all channels (b = 0.04).
    const int radius =
        static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi_d * pi_d)) * pixels_per_degree));
    double total = 0;
    for (const auto& [a, b] : gaussians) {
        const double s = sum(gaussian(radius, pi_d * pi_d / (b * sqr(pixels_per_degree))));
        total += a * std::sqrt(pi_d / b) * s * s;
    }
    Plane out(in.width, in.height);
    for (const auto& [a, b] : gaussians) {
        const Kernel kernel = gaussian(radius, pi_d * pi_d / (b * sqr(pixels_per_degree)));
        Kernel weighted = kernel;
        scale(weighted, a * std::sqrt(pi_d / b) / total);
        const Plane part = filter(in, weighted, kernel);
        for (size_t i = 0; i < out.values.size(); ++i) out.values[i] += part.values[i];
    }
    return out;
}

struct Features {
    Plane edges, points;
};

// Strengths of edges and points (section 4.2): first and second derivatives of a Gaussian as wide
// as the eye's edge detector, w = 0.082 degrees.
Features find_features(const Plane& lightness, double pixels_per_degree) {
    const double sigma = 0.5 * 0.082 * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    Kernel smooth = gaussian(radius, 1 / (2 * sigma * sigma));
    Kernel first = smooth, second = smooth;
    for (int i = -radius; i <= radius; ++i) {
        first[i + radius] *= -i;
        second[i + radius] *= i * i / (sigma * sigma) - 1;
    }
    balance(first);
    balance(second);
    scale(smooth, 1 / sum(smooth));

    auto strength = [&](const Kernel& derivative) {
        Plane x = filter(lightness, derivative, smooth);
        const Plane y = filter(lightness, smooth, derivative);
        for (size_t i = 0; i < x.values.size(); ++i)
            x.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
        return x;
    };
    return {strength(first), strength(second)};
}

// What the eye gets of an image: filtered colour in Hunt-adjusted L*a*b*, and features.
struct Perceived {
    std::array<Plane, 3> lab;
    Features features;
};

Perceived perceive(const Image& image, double pixels_per_degree) {
    const Plane empty(image.width, image.height);
    std::array<Plane, 3> planes{empty, empty, empty};
    Plane lightness = empty;
    const dmat3 to_xyz = relative_xyz_from_rgb();
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        dvec3 rgb(0);
        for (int c = 0; c < 3; ++c)
            if (image.pixels[i][c] > 0) rgb[c] = std::min(image.pixels[i][c], 1.0f);
        const dvec3 opponent = ycxcz_from_relative_xyz(to_xyz * rgb);
        for (int c = 0; c < 3; ++c) planes[c].values[i] = static_cast<float>(opponent[c]);
        lightness.values[i] = static_cast<float>((opponent.x + 16) / 116);
    }
    planes[0] = sensitivity_filter(planes[0], {{1, 0.0047}}, pixels_per_degree);
    planes[1] = sensitivity_filter(planes[1], {{1, 0.0053}}, pixels_per_degree);
    planes[2] = sensitivity_filter(planes[2], {{34.1, 0.04}, {13.5, 0.025}}, pixels_per_degree);

    const dmat3 to_rgb = glm::inverse(to_xyz);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        const dvec3 opponent(planes[0].values[i], planes[1].values[i], planes[2].values[i]);
        const dvec3 rgb =
            glm::clamp(to_rgb * relative_xyz_from_ycxcz(opponent), dvec3(0), dvec3(1));
        const dvec3 lab = hunt_lab_from_relative_xyz(to_xyz * rgb);
        for (int c = 0; c < 3; ++c) planes[c].values[i] = static_cast<float>(lab[c]);
    }
    return {std::move(planes), find_features(lightness, pixels_per_degree)};
}

// Colour difference in [0, 1] (section 4.1.3): small ones get most of the range.
double redistribute(double difference, double largest) {
    constexpr double pc = 0.4, pt = 0.95;
    const double knee = pc * largest;
    if (difference < knee) return pt / knee * difference;
    return pt + (difference - knee) / (largest - knee) * (1 - pt);
}

}  // namespace

std::vector<float> flip_map(const Image& test, const Image& reference, double pixels_per_degree) {
    constexpr double qc = 0.7, qf = 0.5;
    const Perceived a = perceive(test, pixels_per_degree);
    const Perceived b = perceive(reference, pixels_per_degree);
    const dmat3 to_xyz = relative_xyz_from_rgb();
    const double largest = std::pow(hyab(hunt_lab_from_relative_xyz(to_xyz * dvec3(0, 1, 0)),
                                         hunt_lab_from_relative_xyz(to_xyz * dvec3(0, 0, 1))),
                                    qc);
    std::vector<float> map(test.pixels.size());
    for (size_t i = 0; i < map.size(); ++i) {
        const dvec3 lab_a(a.lab[0].values[i], a.lab[1].values[i], a.lab[2].values[i]);
        const dvec3 lab_b(b.lab[0].values[i], b.lab[1].values[i], b.lab[2].values[i]);
        const double colour = redistribute(std::pow(hyab(lab_a, lab_b), qc), largest);
        const double feature =
            std::max(std::abs(a.features.edges.values[i] - b.features.edges.values[i]),
                     std::abs(a.features.points.values[i] - b.features.points.values[i]));
        const double exponent = 1 - std::pow(feature / std::sqrt(2.0), qf);
        map[i] = static_cast<float>(std::pow(colour, exponent));
    }
    return map;
}

}  // namespace midway
