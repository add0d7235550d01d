#include "plant/contact.hpp"

#include <algorithm>

namespace interlock::plant {

void Contact::move(bool closed, Microseconds delay) {
  target_ = closed;
  delay_left_ = delay;
  if (delay_left_.count() == 0) {
    change();
  }
}

void Contact::change() {
  if (closed_ != target_) {
    closed_ = target_;
    bounce_left_ = bounce_;
    unread_ = true;
  }
}

void Contact::advance(Microseconds elapsed) {
  bounce_left_ -= std::min(bounce_left_, elapsed);
  if (delay_left_.count() == 0) {
    return;
  }
  delay_left_ -= std::min(delay_left_, elapsed);
  if (delay_left_.count() == 0) {
    change();
  }
}

bool Contact::read(Random& random) {
  if (stuck_) {
    return *stuck_;
  }
  if (unread_) {
    unread_ = false;
    return closed_;
  }
  return bounce_left_.count() > 0 ? random.coin() : closed_;
}

}  // namespace interlock::plant
