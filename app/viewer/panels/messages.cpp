// The log: what was done, what went wrong, one line each.
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

constexpr size_t most_messages = 200;

void gather(App& app) {
    PanelState& p = app.ui.panel;
    const auto add = [&](Message::Kind kind, const std::string& text) {
        if (p.messages.size() == most_messages) p.messages.erase(p.messages.begin());
        p.messages.push_back({kind, text, ImGui::GetTime()});
    };
    if (app.ui.notice != p.last_notice || app.ui.notice_until != p.last_notice_until) {
        p.last_notice = app.ui.notice;
        p.last_notice_until = app.ui.notice_until;
        if (!p.last_notice.empty()) add(Message::Kind::notice, p.last_notice);
    }
    const auto note_error = [&](std::string& last, const std::string& now) {
        if (now == last) return;
        last = now;
        if (!now.empty()) add(Message::Kind::error, now);
    };
    note_error(p.last_error, app.document.error);
    note_error(p.last_render_error, app.snapshot ? app.snapshot->error : std::string());
}

}  // namespace

Change draw_messages(App& app) {
    gather(app);
    if (!ui::begin_section(app, ui::Side::right, "Messages", false)) return {};
    const std::vector<Message>& messages = app.ui.panel.messages;
    if (messages.empty()) ui::wrapped(theme::text_dim, "Nothing so far.");
    for (auto m = messages.rbegin(); m != messages.rend(); ++m) {
        if (m->kind == Message::Kind::error) {
            ui::note(theme::error, m->text);
        } else {
            ui::wrapped(theme::text, m->text);
        }
    }
    ui::end_section(app);
    return {};
}

}  // namespace midway
