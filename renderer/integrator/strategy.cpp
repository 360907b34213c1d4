#include "integrator/strategy.h"

#include <stdexcept>

namespace midway {
namespace {

struct Word {
    std::string_view name;
    bool Families::*member;
};
constexpr Word words[] = {{"emitter", &Families::emitter_hit},
                          {"next-event", &Families::next_event},
                          {"light", &Families::light_tracing},
                          {"connect", &Families::connection}};

std::string_view family_name(Family f) {
    switch (f) {
        case Family::emitter_hit:
            return "emitter hit";
        case Family::next_event:
            return "next event";
        case Family::light_tracing:
            return "light tracing";
        case Family::connection:
            return "connection";
    }
    return "";
}

}  // namespace

Families parse_families(std::string_view text) {
    Families f{false, false, false, false};
    while (!text.empty()) {
        const size_t comma = text.find(',');
        const std::string_view word = text.substr(0, comma);
        bool known = false;
        for (const Word& w : words)
            if (w.name == word) f.*w.member = known = true;
        if (!known)
            throw std::runtime_error("unknown family \"" + std::string(word) +
                                     "\" (--families); use emitter, next-event, light, connect");
        text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
    }
    return f;
}

std::string to_string(const Families& f) {
    std::string s;
    for (const Word& w : words)
        if (f.*w.member) s += (s.empty() ? "" : ",") + std::string(w.name);
    return s;
}

std::string describe(const Strategy& k) {
    return "camera " + std::to_string(k.s) + " · light " + std::to_string(k.t) + ": " +
           std::string(family_name(family_of(k)));
}

}  // namespace midway
