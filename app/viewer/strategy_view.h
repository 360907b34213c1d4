// Strategies in the view: choosing them in the pyramid, what the renderer is asked for, and the
// image that is shown of them.
#pragma once

#include "display_maths.h"

namespace midway {

// Opens the pyramid, or closes it; then the whole image is back.
void open_pyramid(App& app, bool open);

// Shows this strategy alone; or, added to what is shown, puts it in or takes it out.
void choose_strategy(App& app, const Strategy& strategy, bool add);
void show_whole_image(App& app);
bool shows_strategies(const App& app);  // instead of the image

// For LiveRender.
StrategyRequest strategy_request(const App& app);

// Puts the sum of the chosen strategies in the place of the image, where some are chosen: at full
// size, or from the thumbnails until there is one. Exposure is theirs where the person wants so.
void show_strategies(const App& app, ShownImage& shown);

// Whether show_strategies() has full size.
bool strategies_at_full_size(const App& app);

// In words: "camera 3 · light 1: next event"; and for the cell that longer paths share.
std::string strategy_name(const Strategy& strategy);

// For scripts and sessions: "3,1;1,2", "longer" for the shared cell, "none"; empty for anything
// else.
std::optional<std::vector<Strategy>> parse_strategies(const std::string& text);
std::string strategies_text(const std::vector<Strategy>& strategies);

}  // namespace midway
