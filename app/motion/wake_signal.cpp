#include <sys/eventfd.h>

#include "motion/realtime_channel.hpp"

namespace interlock {

WakeSignal::WakeSignal() noexcept : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}

void WakeSignal::signal() const noexcept {
  // A full counter means that the sleeper was signalled often enough already.
  (void)::eventfd_write(event_.get(), 1);
}

void WakeSignal::clear() const noexcept {
  eventfd_t signals = 0;
  (void)::eventfd_read(event_.get(), &signals);
}

}  // namespace interlock
