#include "support/agreement_assets.h"

namespace midway::test {
namespace {

AssetRow row(const std::string& initials, const std::vector<double>& exponents,
             double relative_error, std::uint64_t passes) {
    const bool by_chance = relative_error > 0.005;
    return {families_by_initials(initials), exponents, relative_error, passes, 16, !by_chance};
}

}  // namespace

Families families_by_initials(const std::string& initials) {
    const auto has = [&](char c) { return initials.find(c) != std::string::npos; };
    return {has('E'), has('N'), has('L'), has('C')};
}

std::vector<AssetPlan> asset_plans() {
    const std::vector<double> naive{0}, all{0.5, 1, 2, 8}, some{1, 2}, three{1, 2, 8}, power{2};
    // Of a percent, and one percent. On idol, whose head is noise to every technique, a tenth takes
    // half an hour, and ajar without next event has 0.12 % after 45 minutes. Light tracing on
    // lanterns meets the bulbs mirrored in the wet ground by chance, as on a caustic: single paths
    // of two edges that neither it nor next event alone draws in 10^8 carry half a percent of their
    // light. With more samples the spread of the seeds falls below what is missing; emitter hits,
    // which find these paths at once, are in every other row.
    const double tenth = 0.001, third = 0.003, one = 0.01;
    const std::string sky = std::string(MIDWAY_SOURCE_DIR) + "/assets/terrace_sky.hdr";
    return {
        {"cornell",
         "",
         {row("ENLC", all, tenth, 512), row("EN", all, tenth, 512), row("L", power, tenth, 512),
          row("E", power, tenth, 16384), row("N", power, tenth, 512), row("EL", some, tenth, 512),
          row("EC", some, tenth, 8192), row("NL", some, tenth, 512), row("NC", some, tenth, 512),
          row("LC", some, tenth, 512), row("ENL", some, tenth, 512), row("ENC", some, tenth, 512),
          row("ELC", some, tenth, 512), row("NLC", some, tenth, 512), row("EN", naive, tenth, 4096),
          row("ENL", naive, tenth, 4096)}},
        {"plates",
         "",
         {row("ENLC", some, tenth, 32768), row("EN", some, one, 2048), row("L", power, one, 8192),
          row("ENL", some, one, 1024), row("ENC", some, one, 2048), row("EL", some, one, 1024),
          row("ELC", some, one, 2048)}},
        {"five-lights", "0.1,0.16,0.28", {row("ENLC", all, tenth, 4096)}},
        {"idol",
         "",
         {row("ENLC", some, tenth, 65536), row("EN", some, one, 2048),
          row("ENL", some, third, 4096), row("ENC", some, one, 4096)}},
        {"ajar",
         "",
         {row("ENLC", some, tenth, 5120), row("EN", some, one, 2048),
          row("ENL", some, tenth, 24576), row("ENC", some, tenth, 40960),
          row("EL", some, one, 4096), row("ELC", some, third, 32768)}},
        {"ring",
         "",
         {row("ENLC", some, tenth, 16384), row("EN", some, one, 1024), row("L", power, one, 16384),
          row("ENL", some, tenth, 10240), row("ENC", some, one, 2048),
          row("EL", some, tenth, 28672), row("ELC", some, tenth, 28672)}},
        {"lanterns",
         "",
         {row("ENLC", three, tenth, 4096), row("EN", some, tenth, 16384),
          row("L", power, one, 4096), row("ENL", some, tenth, 4096), row("ENC", some, tenth, 32768),
          row("ELC", some, tenth, 16384)}},
        {"terrace",
         sky,
         {row("ENLC", some, tenth, 8192), row("EN", some, tenth, 16384),
          row("L", power, tenth, 131072), row("N", power, tenth, 8192),
          row("ENL", some, tenth, 8192), row("ENC", some, tenth, 8192),
          row("NL", some, tenth, 8192), row("NC", some, tenth, 8192), row("NLC", some, tenth, 8192),
          row("LC", some, one, 2048)}},
    };
}

}  // namespace midway::test
