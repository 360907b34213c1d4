// Results that are built where they stay. A struct that is copied right after its members were
// written one by one makes the processor wait for those stores (wide loads cannot be served from
// several narrow stores): measured, that was 7 % of a Cornell box's time. Functions that make large
// structs on the hot path therefore name one result and return it alone, which C++ builds in the
// caller's place; build_at() lets them build it in an object that exists already.
#pragma once

#include <memory>
#include <type_traits>

namespace midway {

// Replaces `place` by what `make` returns.
template <class T, class Make>
void build_at(T& place, const Make& make) {
    static_assert(std::is_trivially_destructible_v<T>);
    ::new (static_cast<void*>(std::addressof(place))) T(make());
}

}  // namespace midway
