/**
 * @file
 * What the oracle sees of one tick: the wire, the contacts, what the app said, what the kernel says of
 * itself, and where the axes really are.
 */
#ifndef INTERLOCK_ORACLE_OBSERVATION_HPP
#define INTERLOCK_ORACLE_OBSERVATION_HPP

#include <array>
#include <cstdint>
#include <span>

#include "oracle/rules.hpp"
#include "oracle/wire.hpp"

namespace interlock::oracle {

/** A contact as it was read; a reading that is neither is undefined. */
enum class Contact : std::uint8_t { kOpen, kClosed, kUndefined };

enum class Mode : std::uint8_t { kInit, kLocked, kReady, kMotion };

enum class AxisMode : std::uint8_t { kDisabled, kEnabled, kMoving, kHoming, kFaulted };

enum class Order : std::uint8_t {
  kHeartbeat,
  kStop,
  kReset,
  kEnable,
  kDisable,
  kClearFault,
  kMove,
  kHome,
  kSetHome,
  kRestore,
  kUnknown
};

enum class Answer : std::uint8_t { kNone, kAccepted, kRefused };

/** One request as the app sent it, and the kernel's verdict. */
struct Message {
  Order order = Order::kUnknown;
  bool intact = true; /**< its checksum was right when it was sent */
  std::uint32_t sequence = 0;
  std::uint32_t axis = 0;
  std::uint32_t holder = 0;      /**< HEARTBEAT */
  std::int32_t target = 0;       /**< setpoint of MOVE, position of RESTORE; counts */
  std::uint32_t drive = 0;       /**< MOVE */
  std::uint32_t amplitude = 0;   /**< MOVE */
  std::uint32_t lease_ticks = 0; /**< MOVE */
  Answer answer = Answer::kNone;
};

/** What the kernel says of an axis. */
struct AxisClaim {
  AxisMode mode = AxisMode::kDisabled;
  bool homed = false;
  std::uint32_t fault = 0;   /**< any code, 0 for none */
  std::int32_t position = 0; /**< counts; taken as the origin of an axis that nothing has referenced */
};

struct Claim {
  Mode mode = Mode::kInit;
  std::uint32_t first_cause = 0; /**< any code */
  std::array<AxisClaim, kSlots> axes{};
};

/** Where an axis is, whatever its encoder says. */
struct Truth {
  std::int64_t position = 0; /**< counts of a frame that stays put */
  bool keeps_promise =
      true; /**< counts what it moves and coasts as its rules say; a promise once broken stays so */
};

struct Observation {
  std::uint32_t tick = 0;
  bool transaction_failed = false;
  std::array<bool, kSlots> received{};
  std::array<wire::FrameView, kSlots> from_card{};
  std::array<wire::FrameView, kSlots> to_card{};
  Contact pedal_normally_open = Contact::kOpen;
  Contact pedal_normally_closed = Contact::kClosed;
  Contact estop_loop = Contact::kClosed;
  bool deadlines_missed = false;
  bool app_attached = false; /**< anew, in this tick: sequence numbers restart */
  std::span<const Message> messages;
  std::uint32_t answers = 0; /**< verdicts that the kernel gave */
  Claim claim;
  std::array<Truth, kSlots> truth{};
  bool state_damaged = false; /**< someone changed the kernel's memory before this tick */
  std::uint32_t configuration_damage_ticks =
      0; /**< ticks since someone changed its configuration, this one counted */
  std::span<const wire::FrameView> undamaged; /**< what a twin without damage sent; empty without one */
};

}  // namespace interlock::oracle

#endif
