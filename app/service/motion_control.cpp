#include "service/motion_control.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace interlock {
namespace {

using nlohmann::json;

json to_json(const Claim& claim) {
  return {{"session", claim.session}, {"user", claim.user}, {"since", iso_8601(claim.since)}};
}

}  // namespace

const Claim* MotionControl::request_of(std::uint32_t session) const {
  const auto found = std::ranges::find(requests_, session, &Claim::session);
  return found == requests_.end() ? nullptr : &*found;
}

void MotionControl::give(Claim to) {
  if (held_by(to.session)) {
    return;
  }
  drop_request(to.session);
  holder_ = std::move(to);
  number_ = number_ + 1 != 0 ? number_ + 1 : 1;
  *present_ = number_;
  listener_(true);
}

void MotionControl::request(Claim claim) {
  if (!held_by(claim.session) && request_of(claim.session) == nullptr) {
    requests_.push_back(std::move(claim));
    listener_(false);
  }
}

void MotionControl::release(std::uint32_t session) {
  const bool held = held_by(session);
  const bool requested = drop_request(session);
  if (held) {
    holder_.reset();
    *present_ = 0;
  }
  if (held || requested) {
    listener_(held);
  }
}

json MotionControl::shown_to(std::uint32_t session) const {
  json requests = json::array();
  for (const Claim& claim : requests_) {
    requests.push_back(to_json(claim));
  }
  return {{"holder", holder_ ? to_json(*holder_) : json()},
          {"mine", held_by(session)},
          {"requests", std::move(requests)}};
}

bool MotionControl::drop_request(std::uint32_t session) {
  return std::erase_if(requests_, [&](const Claim& claim) { return claim.session == session; }) != 0;
}

}  // namespace interlock
