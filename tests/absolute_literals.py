"""Small absolute numbers in the part of renderer/ that works with geometry and scattering.

An offset or tolerance of fixed size works at one scale and fails at another, so ray offsets and
comparisons follow from error bounds. A small literal is reported unless it stands in ALLOWED with
the reason why no scale can make it wrong. Hexadecimal literals (0x1p-24) are units in the last
place, and pass.
"""

import re

FOLDERS = ("renderer/math/", "renderer/shading/", "renderer/scene/", "renderer/integrator/",
           "renderer/render/", "renderer/report/drawn_path", "renderer/report/direct_form",
           "renderer/report/whole_path", "renderer/report/audit_leaks",
           "renderer/report/audit_rays")
NUMBER = re.compile(r"(?<![\w.])(\d+\.?\d*(?:e[-+]?\d+)?|\.\d+(?:e[-+]?\d+)?)f?\b", re.I)
NAME = re.compile(r"\b\w*(?:epsilon|\beps\b|self_?intersection_bias|ray_bias)\w*\b", re.I)
SMALL = 0.002
NEAR_ONE = 0.005

# (file, text on the line): reason.
ALLOWED = {
    ("renderer/math/statistics.cpp", "2.515517"): "coefficients of a rational approximation",
    ("renderer/math/statistics.cpp", "1.432788"): "coefficients of a rational approximation",
    ("renderer/math/student.cpp", "tiny = 1e-300"): "keeps a continued fraction from dividing by 0",
    ("renderer/math/student.cpp", "< 1e-15"): "relative: convergence of a continued fraction",
    ("renderer/math/student.cpp", "1e-14 * high"): "relative: convergence of a bisection",
    ("renderer/math/student.cpp", "1e-300, 1 - 1e-16"): "a probability kept inside of (0, 1)",
    ("renderer/math/warp.h", "least_squared_cosine = 1e-12f"): "squared cosine: a sample exactly on "
                                                              "the horizon would have density 0",
    ("renderer/math/warp.h", "3.59542907e-05f"): "coefficients of a sine",
    ("renderer/math/warp.h", "3.52979722e-06f"): "coefficients of a cosine",
    ("renderer/shading/albedo_table.cpp", "1e-3f, m / float(cosines"): "a cosine: the table's row "
                                                                       "at the horizon",
    ("renderer/shading/bsdf.cpp", "std::max(1e-4f, 1 - b.coat_f0"): "an albedo: guards 0 / 0 of a "
                                                                    "coat that reflects all",
    ("renderer/shading/bsdf.cpp", "1e-6f});"): "least share of a lobe in the choice among lobes",
    ("renderer/shading/bsdf.cpp", "matched_index = 1e-3f"): "index of refraction, a pure number",
    ("renderer/shading/microfacet.h", "smooth_alpha = 1e-3f"): "width of a lobe, a pure number",
    ("renderer/shading/microfacet.h", "std::max(h.z, 1e-12f)"): "cosine of a facet's normal",
    ("renderer/shading/texture.cpp", "0.04045"): "the sRGB curve",
    ("renderer/render/pilot.cpp", "trimmed_share = 0.001"): "a share of samples and blocks",
    ("renderer/scene/build_lights.cpp", "least_mean = 1e-3"): "relative to the emission",
    ("renderer/scene/camera.cpp", "std::max(1e-3f, glm::dot"): "default focus of a lens that looks "
                                                               "away from a scene of radius 1",
    ("renderer/scene/camera.cpp", "0.99999 ?"): "cosine: a view straight up has no horizon",
    ("renderer/scene/lamps.cpp", "skew = 1e-3f"): "relative to the lamp's diagonal",
    ("renderer/scene/light.cpp", "1e-9f * ramp"): "relative to the ramp of the spot",
    ("renderer/render/scene_edits.cpp", "widest_inner = 0.999f"): "a ratio of angles",
    ("renderer/render/scene_edits.h", "narrowest_cone = 1e-3f"): "an angle in radians",
    ("renderer/shading/texture.cpp", "ior - 1) < 1e-3f"): "index of refraction, as matched_index",
    ("renderer/render/renderer.cpp", "1e-9 *"): "nanoseconds",
    ("renderer/render/waves.cpp", "1e-9"): "seconds",
    ("renderer/render/live_job.cpp", "40e-6"): "seconds",
    ("renderer/render/live_job.cpp", "0.3e-6"): "seconds",
    ("renderer/render/live_render.cpp", "1e-9"): "seconds",
    ("renderer/report/drawn_path.cpp", "closest = 0.999f"): "cosine: which of two delta lobes leads "
                                                            "along an edge",
    ("renderer/report/drawn_path.cpp", "1e-7f, 1 - 0x1p-24f"): "a random number inside of (0, 1)",
    ("renderer/report/drawn_path.cpp", "< 1e-8f"): "tells another surface in the way from the lamp, "
                                                   "in a scene of radius 1; the audit's alone",
}


def is_suspicious(code):
    if NAME.search(code):
        return True
    for match in NUMBER.finditer(code):
        value = float(match[1])
        if 0 < value < SMALL or 0 < abs(value - 1) < NEAR_ONE:
            return True
    return False


def absolute_literals(path, code):
    """Lines of `code` (comments and literals of text blanked) that need a reason."""
    if not path.startswith(FOLDERS):
        return
    lines = code.splitlines()
    for number, line in enumerate(lines, 1):
        allowed = any(path == file and text in line for file, text in ALLOWED)
        if not allowed and is_suspicious(line):
            yield (f"{path}:{number}: a small absolute number; use an error bound, or say in "
                   "tests/absolute_literals.py why no scale makes it wrong")


def stale_reasons(root):
    """Entries of ALLOWED that no line needs any more."""
    for file, text in ALLOWED:
        if (root / file).is_file() and text not in (root / file).read_text(encoding="utf-8"):
            yield f"{file}: no line holds \"{text}\" (tests/absolute_literals.py)"
