#include "sample_output.h"

#include <fmt/format.h>

namespace midway {
namespace {

std::string in_words(const Density& d) {
    switch (d.measure) {
        case Measure::per_area:
            return fmt::format("{:.6g}/area", d.value);
        case Measure::per_solid_angle:
            return fmt::format("{:.6g}/sr", d.value);
        case Measure::probability:
            return fmt::format("{:.6g}", d.value);
        case Measure::none:
            break;
    }
    return "-";
}

void print_vertex(const InspectedVertex& v, char side, size_t number) {
    fmt::print("  {}{} {} {} {:.6g} {:.6g} {:.6g}", side, number, to_string(v.kind),
               v.infinite ? "direction" : "at", v.position.x, v.position.y, v.position.z);
    if (v.object >= 0) fmt::print("  \"{}\" \"{}\"", v.object_name, v.material_name);
    if (v.kind == VertexKind::surface)
        fmt::print("  {} roughness {:.3g}",
                   v.black                     ? "black"
                   : v.delta || !v.connectible ? "delta"
                                               : "scatters",
                   v.roughness);
    fmt::print("  pdf_fwd {}  pdf_rev {}  throughput {:.6g} {:.6g} {:.6g}\n", in_words(v.fwd),
               in_words(v.rev), v.throughput.x, v.throughput.y, v.throughput.z);
}

void print_strategy(const InspectedStrategy& s, const InspectedSample& sample, bool found) {
    fmt::print("    {}{}", found ? "* " : "  ", describe(s.strategy));
    if (!s.feasible) {
        fmt::print("  cannot make this path\n");
        return;
    }
    fmt::print("  log10(n p) {:.6f}", s.log10_pdf);
    for (size_t i = 0; i < sample.exponents.size(); ++i)
        fmt::print("  weight({:g}) {:.9g} direct {:.9g}", sample.exponents[i], s.weights[i],
                   s.direct[i]);
    fmt::print("\n");
}

void print_path(const InspectedPath& p, const InspectedSample& sample) {
    const Contribution& k = p.contribution;
    fmt::print("  {} value {:.9g} {:.9g} {:.9g}", describe(k.strategy), k.value.x, k.value.y,
               k.value.z);
    for (size_t i = 0; i < sample.exponents.size(); ++i)
        fmt::print("  weight({:g}) {:.9g}", sample.exponents[i], k.weights[i]);
    if (p.splat) fmt::print("  splat to {},{}", p.x, p.y);
    if (p.neighbour) fmt::print("  with light subpath {}", sample.neighbours[*p.neighbour].number);
    fmt::print("{}{}\n", p.clamped ? "  clamped" : "", p.usable ? "" : "  not finite");
    for (auto s = p.strategies.rbegin(); s != p.strategies.rend(); ++s)
        if (!(s->strategy == Strategy{1, 1})) print_strategy(*s, sample, s->strategy == k.strategy);
}

}  // namespace

void print_sample(const InspectedSample& sample) {
    fmt::print("pixel {},{} sample {} {}\n", sample.x, sample.y, sample.pass,
               sample.light_subpath ? fmt::format("light subpath {}", *sample.light_subpath)
                                    : "no light subpath");
    for (size_t i = 0; i < sample.camera.size(); ++i) print_vertex(sample.camera[i], 'C', i);
    for (size_t i = 0; i < sample.light.size(); ++i) print_vertex(sample.light[i], 'L', i);
    for (const NeighbourSubpath& n : sample.neighbours) {
        fmt::print("light subpath {} of {},{}, shared\n", n.number, n.x, n.y);
        for (size_t i = 0; i < n.vertices.size(); ++i) print_vertex(n.vertices[i], 'L', i);
    }
    if (!sample.neighbours.empty()) fmt::print("paths of {},{}\n", sample.x, sample.y);
    for (const InspectedPath& p : sample.paths) print_path(p, sample);
}

}  // namespace midway
