// Large arrays that are read or written at random: in pages of two megabytes instead of four
// kilobytes the processor finds their places without walking its page tables. Splats into a film of
// 512x512 pixels waited for that more than for the memory itself.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>

namespace midway {

// Asks for large pages where memory that nobody has touched yet is large enough; no more than a
// hint, which systems may ignore.
inline void ask_for_huge_pages(void* memory, std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t huge = std::uintptr_t{1} << 21, page = 4096;
    if (bytes < 2 * huge) return;
    const auto begin = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (begin + page - 1) / page * page;
    const std::uintptr_t last = (begin + bytes) / page * page;
    (void)madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#else
    (void)memory, (void)bytes;
#endif
}

}  // namespace midway
