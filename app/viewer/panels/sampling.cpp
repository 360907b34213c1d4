// The finer choices about light transport.
#include <array>

#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

struct FamilyRow {
    const char* label;
    const char* tooltip;
    bool Families::*member;
    theme::Color color;
};
constexpr std::array<FamilyRow, 4> family_rows = {{
    {"Emitter hit", "Light 0: the camera walk runs into a lamp or leaves into the sky.",
     &Families::emitter_hit, theme::camera},
    {"Next event", "Light 1: from every surface of the camera walk, a point on a light is chosen.",
     &Families::next_event, theme::camera},
    {"Light tracing", "Camera 1: every surface of the light walk is joined to the lens.",
     &Families::light_tracing, theme::light},
    {"Connection", "Camera and light 2 or more: surfaces of the two walks are joined.",
     &Families::connection, theme::light},
}};

bool any(const Families& f) {
    return f.emitter_hit || f.next_event || f.light_tracing || f.connection;
}

Change draw_families(App& app) {
    Change change;
    RenderSettings& s = app.render.settings;
    const Families of_technique = families_of(s.technique);
    Families families = s.families.value_or(of_technique);
    ui::heading("Families of strategies");
    ui::tip("Taken out, a family is missing from the image and from the weights of the others.");
    for (size_t i = 0; i < family_rows.size(); ++i) {
        const FamilyRow& row = family_rows[i];
        if (i % 2 == 1) ImGui::SameLine(ImGui::GetWindowContentRegionMax().x / 2 + ui::em(0.2f));
        ImGui::BeginDisabled(!(of_technique.*row.member));
        ImGui::PushStyleColor(ImGuiCol_CheckMark, row.color);
        bool on = families.*row.member;
        if (ImGui::Checkbox(row.label, &on)) {
            Families next = families;
            next.*row.member = on;
            // With none there is nothing to render.
            if (any(next)) {
                families = next;
                s.families = next == of_technique ? std::optional<Families>() : next;
                change.settings = true;
            }
        }
        ImGui::PopStyleColor();
        ImGui::EndDisabled();
        ui::tip(row.tooltip);
    }
    return change;
}

Change draw_sampler_and_filter(RenderSettings& s) {
    Change change;
    constexpr std::array<ui::Choice, 2> samplers = {{
        {"Sobol", "Owen-scrambled Sobol points: well spread, less noise for the same samples."},
        {"Independent", "Independent random numbers: the textbook's own."},
    }};
    ui::row("Sampler", "Where the random numbers come from.");
    int sampler = static_cast<int>(s.sampler);
    if (ui::segmented("sampler", samplers, sampler)) {
        s.sampler = static_cast<SamplerKind>(sampler);
        change.settings = true;
    }
    ui::row("Filter", "How samples near a pixel count for it.");
    constexpr std::array<const char*, 3> filters{"Box", "Gaussian", "Blackman-Harris"};
    int filter = static_cast<int>(s.filter);
    if (ImGui::Combo("##filter", &filter, filters.data(), static_cast<int>(filters.size()))) {
        s.filter = static_cast<FilterKind>(filter);
        change.settings = true;
    }
    ui::tip(
        "Box: every sample counts for its own pixel alone. Gaussian: soft. Blackman-Harris, the "
        "default: soft edges without ringing.");
    return change;
}

Change draw_numbers(App& app) {
    Change change;
    RenderSettings& s = app.render.settings;
    ui::row("Bounces",
            "Most scattering events of a path. 0 shows only emitters, 1 adds direct light.");
    int bounces = s.max_bounces;
    if (ImGui::SliderInt("##bounces", &bounces, 0, 32, "%d", ImGuiSliderFlags_None) &&
        bounces >= 0 && bounces <= 64 && bounces != s.max_bounces) {
        s.max_bounces = bounces;
        change.settings = true;
    }
    ui::tip("Ctrl+click to type a number.");
    ui::row("Seed", "Another seed, other random numbers: the same image with other noise.");
    std::uint64_t seed = s.seed;
    const std::uint64_t one = 1;
    if (ImGui::InputScalar("##seed", ImGuiDataType_U64, &seed, &one, nullptr, "%llu") &&
        seed != s.seed) {
        s.seed = seed;
        change.settings = true;
    }
    ui::row("Threads", "Workers that render; 0 stands for one on every processor.");
    int threads = app.render.threads;
    if (ImGui::InputInt("##threads", &threads, 1, 1) && threads >= 0 && threads <= 1024 &&
        threads != app.render.threads) {
        app.render.threads = threads;
        change.settings = true;
    }
    return change;
}

Change draw_clamp(RenderSettings& s) {
    Change change;
    bool clamps = s.clamp.has_value();
    if (ImGui::Checkbox("Clamp", &clamps)) {
        s.clamp = clamps ? std::optional<float>(10.0f) : std::nullopt;
        change.settings = true;
    }
    ui::tip(
        "Cuts the largest contributions: fewer fireflies, but light is lost and the image is no "
        "longer right. Off by default.");
    if (s.clamp) {
        ImGui::SameLine(ui::em(6.4f));
        ImGui::SetNextItemWidth(-1);
        double value = *s.clamp;
        if (ui::drag_number("##clamp", value, 1e-3, 1e6, "%.4g")) {
            s.clamp = static_cast<float>(value);
            change.settings = true;
        }
        ui::note(theme::light, "Clamped: this image is biased.");
    }
    return change;
}

}  // namespace

Change draw_sampling(App& app) {
    if (!ui::begin_section(app, ui::Side::left, "Sampling", false)) return {};
    Change change = draw_families(app);
    change |= draw_numbers(app);
    change |= draw_sampler_and_filter(app.render.settings);
    change |= draw_clamp(app.render.settings);
    ui::end_section(app);
    return change;
}

}  // namespace midway
