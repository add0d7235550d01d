#include "http/jog_desk.hpp"

#include <algorithm>

namespace interlock::web {

void JogDesk::begin(std::uint32_t proposal, const ControlView& view, TimePoint now) {
  jogs_.push_back({proposal});
  jogs_.back().lease.hold(view, now);
}

bool JogDesk::renew(std::uint32_t proposal, const ControlView& view, TimePoint now) {
  const auto jog = std::ranges::find(jogs_, proposal, &Jog::proposal);
  if (jog == jogs_.end() || jog->lease.overdue(view, now)) {
    return false;
  }
  jog->lease.hold(view, now);
  return true;
}

void JogDesk::end(std::uint32_t proposal) {
  std::erase_if(jogs_, [&](const Jog& jog) { return jog.proposal == proposal; });
}

std::vector<std::uint32_t> JogDesk::lapsed(const ControlView& view, TimePoint now) const {
  std::vector<std::uint32_t> lapsed;
  for (const Jog& jog : jogs_) {
    if (jog.lease.overdue(view, now)) {
      lapsed.push_back(jog.proposal);
    }
  }
  return lapsed;
}

std::vector<std::uint32_t> JogDesk::running() const {
  std::vector<std::uint32_t> running;
  for (const Jog& jog : jogs_) {
    running.push_back(jog.proposal);
  }
  return running;
}

}  // namespace interlock::web
