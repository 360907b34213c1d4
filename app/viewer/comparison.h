// How A and B are shown together: which image is A, whether the two can be compared, what is said
// of them, and the arithmetic of the wipe and of the difference beside that of display_maths.h.
#pragma once

#include "display_maths.h"
#include "state.h"

namespace midway {

// Null where none is chosen.
const KeptImage* image_a(const App& app);

// Why A cannot be laid over B, in words that follow "because"; empty where it can, or where there
// is no A.
std::string view_refusal(const App& app);

// What else makes A another image though it lies over B ("the scene was edited"); empty: nothing.
std::string a_remark(const App& app);

// The view that is asked for, or what is left of it: another channel than the image is never
// compared, an image of another view only looked at.
CompareView view_in_use(const App& app);

// "A: path, 128 samples"; "B: bdpt:2, 64 samples".
std::string caption_a(const App& app);
std::string caption_b(const App& app);

// Bytes that the kept images take.
size_t kept_bytes(const CompareState& comparison);

// All that a comparison's look depends on besides the snapshot and DisplayChoices.
struct CompareLook {
    CompareView view = CompareView::live;
    const Image* a = nullptr;
    float wipe = 0, range = 0;
    bool relative = false;
    bool operator==(const CompareLook&) const = default;
};
CompareLook compare_look(const App& app);

// Lays A beside or under what is shown of B.
void show_comparison(const App& app, ShownImage& shown);

// The picture of a wipe or of a difference: all pixels that it has in the whole image.
Image compared_colours(const ShownImage& shown);

}  // namespace midway
