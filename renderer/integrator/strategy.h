// Strategies (s, t): s camera vertices and t light vertices (the seed's order; Veach, pbrt and
// Mitsuba write them the other way round). A path with k edges has s + t = k + 1.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "math/vector.h"

namespace midway {

struct Strategy {
    int s = 0, t = 0;
    constexpr int edges() const { return s + t - 1; }
    bool operator==(const Strategy&) const = default;
};

// A dense numbering: paths by length, within a length by s.
constexpr size_t strategy_index(const Strategy& k) {
    const size_t edges = static_cast<size_t>(k.edges());
    return edges * (edges - 1) / 2 + edges - 1 + static_cast<size_t>(k.s) - 1;
}
// Strategies (s, t) with at most `edges` edges have an index below this.
constexpr size_t strategy_count(int edges) { return strategy_index({1, edges + 1}); }

enum class Family : std::uint8_t { emitter_hit, next_event, light_tracing, connection };

constexpr Family family_of(const Strategy& k) {
    if (k.t == 0) return Family::emitter_hit;
    if (k.t == 1) return Family::next_event;
    return k.s == 1 ? Family::light_tracing : Family::connection;
}

// Which families take part, in the image and in the weights.
struct Families {
    bool emitter_hit = true, next_event = true, light_tracing = true, connection = true;

    bool has(Family f) const {
        switch (f) {
            case Family::emitter_hit:
                return emitter_hit;
            case Family::next_event:
                return next_event;
            case Family::light_tracing:
                return light_tracing;
            case Family::connection:
                return connection;
        }
        return false;
    }
    bool needs_light_subpaths() const { return light_tracing || connection; }
    bool operator==(const Families&) const = default;
    Families operator&(const Families& o) const {
        return {emitter_hit && o.emitter_hit, next_event && o.next_event,
                light_tracing && o.light_tracing, connection && o.connection};
    }
    Families operator|(const Families& o) const {
        return {emitter_hit || o.emitter_hit, next_event || o.next_event,
                light_tracing || o.light_tracing, connection || o.connection};
    }
};

// "emitter,next-event,light,connect", any subset; throws std::runtime_error for other words.
Families parse_families(std::string_view text);
std::string to_string(const Families& families);

// In words, camera first: "camera 2 · light 3: connection".
std::string describe(const Strategy& strategy);

}  // namespace midway
