// Vectors and small helpers. GLM supplies the types; this header only names those that the renderer
// uses and adds what GLM lacks. All directions point away from the surface they are given at.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace midway {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float pi = 3.14159265358979323846f;
inline constexpr float inv_pi = 0.31830988618379067154f;

inline float sqr(float x) { return x * x; }
inline double sqr(double x) { return x * x; }

// Square root that takes the small negative results of rounding as zero.
inline float safe_sqrt(float x) { return std::sqrt(std::max(x, 0.0f)); }

inline float abs_dot(const vec3& a, const vec3& b) { return std::abs(glm::dot(a, b)); }
inline float length_squared(const vec3& v) { return glm::dot(v, v); }
inline float max_component(const vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline bool is_black(const vec3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }
inline bool is_finite(const vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Relative luminance of linear Rec. 709 RGB (ITU-R BT.709).
inline float luminance(const vec3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline double luminance(const dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

}  // namespace midway
