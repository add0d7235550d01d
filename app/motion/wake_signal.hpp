/**
 * @file
 * Wakes a thread that sleeps in poll or in an event loop: an eventfd.
 */
#pragma once

#include "link/file_descriptor.hpp"

namespace interlock {

/** Signals coalesce: many before a look are one. */
class WakeSignal {
 public:
  /** `descriptor()` is negative when the system has no descriptor left. */
  WakeSignal() noexcept;

  /** Never blocks, never fails. */
  void signal() const noexcept;

  /** Takes the signals that came. */
  void clear() const noexcept;

  /** Readable while a signal is there. */
  [[nodiscard]] int descriptor() const noexcept { return event_.get(); }

 private:
  FileDescriptor event_;
};

}  // namespace interlock
