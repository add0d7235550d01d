/**
 * @file
 * A stage for the oracle: frames, contacts, requests and claims of a system that does nothing wrong, tick by
 * tick, until a test makes it.
 */
#ifndef INTERLOCK_TESTS_ORACLE_STAGE_HPP
#define INTERLOCK_TESTS_ORACLE_STAGE_HPP

#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "oracle/oracle.hpp"

namespace interlock::oracle::test {

inline constexpr std::uint32_t kDrive = 5000;
inline constexpr std::uint32_t kMaxDrive = 100000;
inline constexpr std::int32_t kSoftMax = 1000;
inline constexpr std::int32_t kCoast = 10;

using Words = std::array<std::uint32_t, 32>;

/** Writes start word and checksum. */
void seal(Words& frame);

/** Two PWM axes in slots 0 and 1, a required sensor card in slot 2. Axis 0 has its switch at the upper end.
 */
SystemRules stage_rules();

/** Plays good ticks; what a test changes between `prepare` and `play` is the fault. */
class Stage {
 public:
  Stage() : oracle_(rules) {}

  /** Lays out the next tick: fresh frames, a HEARTBEAT, the claims and drives as they stand. */
  void prepare();

  /** Shows the prepared tick to the oracle. */
  void play();

  /** So many good ticks. */
  void run(std::uint32_t ticks);

  /** Adds an accepted request to the prepared tick. */
  Message& say(Order order, std::uint32_t axis = 0);

  /** Adds an accepted MOVE of axis 0. */
  Message& say_move(std::int32_t target, std::uint32_t lease_ticks, std::uint32_t drive = kDrive);

  /** Commands axis 0 on the wire from now on; 0 is zero drive, a negative one falls. */
  void drive(std::int64_t signed_drive) { drive_ = signed_drive; }

  void press() { pressed_ = true; }
  void release() { pressed_ = false; }

  /** To READY with the pedal released, armed, and axis 0 enabled. */
  void come_to_ready();

  /** From READY to MOTION; the pedal stays pressed. */
  void come_to_motion();

  /** Makes axis 0 homed by SET_HOME, then lets it be carried to a position while disabled. In READY. */
  void home_at(std::int32_t position);

  /** Seals all frames again, after a test changed them. */
  void seal_all();

  SystemRules rules = stage_rules();
  Observation seen;
  std::array<Words, kSlots> from_card{};
  std::array<Words, kSlots> to_card{};
  std::uint32_t counter = 500; /**< of axis 0 */
  std::int64_t truth = 500;    /**< of axis 0 */
  bool triggered = false;      /**< switch of axis 0 */
  bool app_speaks = true;
  Claim claim;
  std::set<Property> found;

 private:
  Oracle oracle_;
  std::vector<Message> messages_;
  std::uint32_t next_tick_ = 0;
  std::uint32_t sequence_ = 0;
  std::int64_t drive_ = 0;
  bool pressed_ = false;
};

}  // namespace interlock::oracle::test

#endif
