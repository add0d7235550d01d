/**
 * @file
 * The footpedal: a normally open and a normally closed contact that move one after the other.
 */
#ifndef INTERLOCK_PLANT_PEDAL_HPP
#define INTERLOCK_PLANT_PEDAL_HPP

#include "plant/contact.hpp"

namespace interlock::plant {

/** The contact that opens moves first: the normally closed one at a press, the normally open one at release.
 */
class Pedal {
 public:
  explicit Pedal(const PedalParameters& parameters)
      : lag_(parameters.lag),
        normally_open_(false, parameters.bounce),
        normally_closed_(true, parameters.bounce) {}

  void press(bool pressed) {
    if (pressed == pressed_) {
      return;
    }
    pressed_ = pressed;
    (pressed ? normally_closed_ : normally_open_).move(false);
    (pressed ? normally_open_ : normally_closed_).move(true, lag_);
  }

  void advance(Microseconds elapsed) {
    normally_open_.advance(elapsed);
    normally_closed_.advance(elapsed);
  }

  /** The foot is on it. */
  bool is_pressed() const { return pressed_; }

  bool has_stuck_contact() const { return normally_open_.stuck() || normally_closed_.stuck(); }

  Contact& normally_open() { return normally_open_; }
  const Contact& normally_open() const { return normally_open_; }
  Contact& normally_closed() { return normally_closed_; }
  const Contact& normally_closed() const { return normally_closed_; }

 private:
  Microseconds lag_;
  Contact normally_open_;
  Contact normally_closed_;
  bool pressed_ = false;
};

}  // namespace interlock::plant

#endif
