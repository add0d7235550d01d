/**
 * @file
 * Hands the newest value from one writing thread to one reading thread. Neither ever waits for the other.
 */
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace interlock {

/**
 * Three copies: one that the writer fills, one that the reader looks at, and one in between, which holds the
 * newest value. Each side swaps its own copy with the one in between.
 */
template <typename T>
class TripleBuffer {
 public:
  /** Writer only: the copy to fill. Its old content is undefined. */
  [[nodiscard]] T& writing() noexcept { return copies_[writing_]; }

  /** Writer only: makes the filled copy the newest. */
  void publish() noexcept {
    const std::uint32_t before = between_.exchange(writing_ | fresh, std::memory_order_acq_rel);
    writing_ = before & index;
  }

  /** Reader only: the value that `newest` gave last. */
  [[nodiscard]] const T& current() const noexcept { return copies_[reading_]; }

  /** Reader only: the newest value; the reference holds until the next call. */
  [[nodiscard]] const T& newest() noexcept {
    if ((between_.load(std::memory_order_relaxed) & fresh) != 0) {
      const std::uint32_t before = between_.exchange(reading_, std::memory_order_acq_rel);
      reading_ = before & index;
    }
    return copies_[reading_];
  }

 private:
  static constexpr std::uint32_t index = 3;
  static constexpr std::uint32_t fresh = 4;

  std::array<T, 3> copies_{};
  std::uint32_t writing_ = 0;
  std::uint32_t reading_ = 1;
  std::atomic<std::uint32_t> between_{2};
};

}  // namespace interlock
