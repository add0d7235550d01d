/**
 * @file
 * A mechanical contact that bounces, can be stuck, and may settle after another one.
 */
#ifndef INTERLOCK_PLANT_CONTACT_HPP
#define INTERLOCK_PLANT_CONTACT_HPP

#include <optional>

#include "plant/parameters.hpp"
#include "plant/random.hpp"

namespace interlock::plant {

/** Bounces after each change; the first reading after it always shows the new state. */
class Contact {
 public:
  Contact(bool closed, Microseconds bounce) : bounce_(bounce), target_(closed), closed_(closed) {}

  /** Moves the contact after a delay; a move that is still under way is replaced. */
  void move(bool closed, Microseconds delay = Microseconds{0});

  /** Sticks the contact, or frees it. */
  void stick(std::optional<bool> closed) { stuck_ = closed; }

  /** What is read whatever the mechanism does; nothing when it is free. */
  std::optional<bool> stuck() const { return stuck_; }

  /** Lets time pass. */
  void advance(Microseconds elapsed);

  /** What is read now: true is closed. */
  bool read(Random& random);

  /** Where the mechanism stands, bounce and sticking apart. */
  bool closed() const { return closed_; }

 private:
  void change();

  Microseconds bounce_;
  Microseconds delay_left_{0};
  Microseconds bounce_left_{0};
  bool target_;
  bool closed_;
  bool unread_ = false;
  std::optional<bool> stuck_;
};

}  // namespace interlock::plant

#endif
