// What the strategy pyramid says about a cell: what it is good at, its shares, why it is left out.
#pragma once

#include "state.h"
#include "theme.h"

namespace midway {

// Shares of the sums over all cells, 0..1; 0 where there is nothing.
struct CellShares {
    double light = 0, noise = 0, rays = 0;
    double of(PyramidShare share) const {
        return share == PyramidShare::light ? light : share == PyramidShare::noise ? noise : rays;
    }
};
CellShares shares_of(const StrategySnapshot& strategies, const Strategy& strategy);

// "12 %", "3.4 %", "< 0.1 %"; a dash for nothing.
std::string percent(double share);

std::string samples_in_words(std::uint64_t n);  // "12 samples per pixel"

std::string what_it_does(const Strategy& strategy);

// Teal is the camera's side, amber the light's; a connection lies between them.
theme::Color family_color(Family family);

// Finds out why strategies are left out, once for each job.
void update_left_out(App& app);
std::string left_out_reason(const App& app, const Strategy& strategy);  // empty: takes part

}  // namespace midway
