#include "motion/request_port.hpp"

namespace interlock {

bool RequestPort::send(const ilk_request_t& request, const RequestOrigin& origin) noexcept {
  if (left_ == 0) {
    return false;
  }
  const std::uint32_t sequence = link_.send(request);
  if (sequence == 0) {
    return false;
  }
  --left_;
  flights_[sequence % flights] = Flight{sequence, origin};
  return true;
}

std::optional<RequestOrigin> RequestPort::settle(std::uint32_t sequence) noexcept {
  Flight& flight = flights_[sequence % flights];
  if (sequence == 0 || flight.sequence != sequence) {
    return std::nullopt;
  }
  const RequestOrigin origin = flight.origin;
  flight = Flight{};
  return origin;
}

}  // namespace interlock
