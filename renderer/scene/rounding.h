// How far rounding may move a point on a triangle, and the ends of rays that keep clear of it
// (geometry.h), for one or for eight of them.
#pragma once

#include "math/lanes.h"

namespace midway {

// Rounding steps that a position goes through (barycentric sum, Embree's plane test, the offset
// itself), each worth half a unit in the last place of the largest number involved.
inline constexpr float error_steps = 12;
inline constexpr float half_ulp = 0x1p-24f;

template <class F>
F rounding_error(const F& largest) {
    return error_steps * half_ulp * largest;
}

// As those of geometry.h.
inline Vec3x8 offset_origin(const Vec3x8& position, const Vec3x8& ng, const Float8& error,
                            const Vec3x8& towards) {
    return position + ng * copy_sign(error, dot(ng, towards));
}
inline Vec3x8 offset_end(const Vec3x8& position, const Vec3x8& ng, const Float8& error,
                         const Vec3x8& from) {
    const Vec3x8 back = from - position;
    const Float8 far_error = rounding_error(max_component(abs(back)));
    return offset_origin(position, ng, error + far_error, back);
}

}  // namespace midway
