#include "http/login_guard.hpp"

#include <algorithm>

namespace interlock::web {
namespace {

constexpr unsigned free_attempts = 3;
constexpr std::chrono::seconds longest_wait{60};
constexpr std::size_t longest_name = 32;

/** No user has a longer name, so that memory is not a stranger's to fill. */
std::string key_of(const std::string& name) { return name.substr(0, longest_name + 1); }

/** 1 s after the third wrong password, doubled each time. */
std::chrono::seconds wait_after(unsigned wrong) {
  if (wrong < free_attempts) {
    return std::chrono::seconds(0);
  }
  const unsigned doublings = std::min(wrong - free_attempts, 6u);
  return std::min(std::chrono::seconds(1u << doublings), longest_wait);
}

}  // namespace

std::chrono::seconds LoginGuard::wait(const std::string& name, SteadyTime now) const {
  const auto found = attempts_.find(key_of(name));
  if (found == attempts_.end()) {
    return std::chrono::seconds(0);
  }
  const auto left = found->second.last + wait_after(found->second.wrong) - now;
  return std::max(std::chrono::ceil<std::chrono::seconds>(left), std::chrono::seconds(0));
}

void LoginGuard::begin(const std::string& name, SteadyTime now) {
  if (attempts_.size() >= capacity && !attempts_.contains(key_of(name))) {
    attempts_.erase(
        std::ranges::min_element(attempts_, {}, [](const auto& each) { return each.second.last; }));
  }
  Attempts& attempts = attempts_[key_of(name)];
  ++attempts.wrong;
  attempts.last = now;
}

void LoginGuard::end(const std::string& name, bool right) {
  if (right) {
    attempts_.erase(key_of(name));
  }
}

void LoginGuard::end_unjudged(const std::string& name) {
  if (const auto found = attempts_.find(key_of(name)); found != attempts_.end()) {
    --found->second.wrong;
  }
}

}  // namespace interlock::web
