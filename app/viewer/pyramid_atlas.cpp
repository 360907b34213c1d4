#include "pyramid_atlas.h"

#include <cmath>

namespace midway {

PyramidAtlas::PyramidAtlas(const Gl& gl)
    : gl_(gl),
      colouring_(gl),
      values_(make_texture(gl)),
      colours_(make_texture(gl)),
      target_(make_framebuffer(gl)) {}

void PyramidAtlas::update(App& app) {
    PyramidPanel& panel = app.ui.panel.pyramid;
    const auto strategies = app.snapshot ? app.snapshot->strategies : nullptr;
    if (!app.display.pyramid.open || !strategies || !strategies->weighted) {
        // Thumbnails of a moment ago are better than none while the next are on their way.
        if (!app.display.pyramid.open) {
            panel.picture = 0;
            panel.drawn.reset();
            strategies_.reset();
        }
        return;
    }
    DisplayChoices choices = app.display;
    choices.zoom = 0;
    choices.pan = vec2(0);
    choices.pyramid.selected.clear();
    choices.pyramid.seen.clear();
    if (strategies == strategies_ && choices == choices_) return;
    const bool other_image =
        strategies != strategies_ || choices.pyramid.bare != choices_.pyramid.bare;
    if (other_image) upload(choices.pyramid.bare ? *strategies->bare : *strategies->weighted);
    strategies_ = panel.drawn = strategies;
    choices_ = choices;
    panel.picture = *colours_;
    colour(app, *strategies);
}

void PyramidAtlas::upload(const Image& image) {
    const ivec2 size(image.width, image.height);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.BindTexture(GL_TEXTURE_2D, *values_);
    if (size != values_size_) {
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, size.x, size.y, 0, GL_RGB, GL_FLOAT,
                       image.pixels.data());
        set_filter(gl_, GL_NEAREST);
        values_size_ = size;
    } else {
        gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, GL_RGB, GL_FLOAT,
                          image.pixels.data());
    }
}

void PyramidAtlas::colour(const App& app, const StrategySnapshot& s) {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, *target_);
    if (colours_size_ != values_size_) {
        gl_.BindTexture(GL_TEXTURE_2D, *colours_);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, values_size_.x, values_size_.y, 0, GL_RGBA,
                       GL_UNSIGNED_BYTE, nullptr);
        set_filter(gl_, GL_LINEAR);
        gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *colours_, 0);
        colours_size_ = values_size_;
    }
    gl_.Disable(GL_BLEND);
    gl_.Viewport(0, 0, values_size_.x, values_size_.y);
    const DisplayChoices& d = app.display;
    DisplayMaths maths;
    maths.curve = d.curve;
    maths.scale = std::exp2(d.exposure_ev);
    if (d.false_colour) {
        maths.mode = DisplayMode::stops;
        maths.range = {d.stop_low, d.stop_high};
    }
    if (!d.pyramid.own_exposure) {
        gl_.Disable(GL_SCISSOR_TEST);
        colouring_.draw(*values_, maths, {});
        return;
    }
    gl_.Enable(GL_SCISSOR_TEST);
    for (size_t i = 0; i < s.cells.size(); ++i) {
        const int x = static_cast<int>(i) % s.columns, y = static_cast<int>(i) / s.columns;
        gl_.Scissor(x * s.tile_width, y * s.tile_height, s.tile_width, s.tile_height);
        const CellSnapshot& cell = s.cells[i];
        maths.scale = std::exp2(d.pyramid.bare ? cell.bare_ev : cell.weighted_ev);
        colouring_.draw(*values_, maths, {});
    }
    gl_.Disable(GL_SCISSOR_TEST);
}

}  // namespace midway
