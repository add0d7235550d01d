/**
 * @file
 * One card: answers frames, hears frames, and drops its amplifier when it hears nothing.
 */
#ifndef INTERLOCK_PLANT_CARD_HPP
#define INTERLOCK_PLANT_CARD_HPP

#include <optional>

#include "plant/encoder.hpp"
#include "plant/wire.hpp"

namespace interlock::plant {

/** How a frame can be spoiled. */
enum class FrameFault : std::uint8_t {
  kCorrupt, /**< one bit of the card's frame is flipped */
  kDrop,    /**< the card's frame does not arrive */
  kDelay,   /**< the card's frame arrives one transaction late */
  kRepeat,  /**< the card sends its last frame again */
  kDeaf,    /**< the card does not hear the kernel */
};

/** What hangs on the card at the moment of a transaction. */
struct Reading {
  double position_counts = 0;
  bool switch_triggered = false;
  wire::AnalogReadings analog{};
};

class Card {
 public:
  /**
   * @param encoder the counter of a motor card; none on a sensor card
   * @param seed of the whole plant; `slot` makes it this card's own
   */
  Card(std::uint32_t type, const std::optional<Encoder>& encoder, std::uint64_t seed, std::size_t slot);

  /**
   * One transaction, as on the wire full duplex: the answer was latched before `heard` came in.
   *
   * @return the frame that the kernel sees, or nothing when the card does not answer
   */
  std::optional<wire::Frame> transact(const Reading& reading, wire::FrameView heard);

  /** Lets time pass; not across the moment at which the watchdog acts (`watchdog_left`). */
  void advance(Microseconds elapsed);

  /** Time until the watchdog drops the amplifier; nothing when it is off already. */
  std::optional<Microseconds> watchdog_left() const;

  /** What the amplifier is told to do now; no drive while it is off. */
  wire::MotorCommand command() const { return amplifier_on() ? command_ : wire::MotorCommand{}; }

  bool amplifier_on() const { return powered_ && command_.amplifier_enabled; }
  bool is_powered() const { return powered_; }
  bool watchdog_tripped() const { return watchdog_tripped_; }
  bool was_reset() const { return was_reset_; }
  std::uint32_t heartbeat() const { return heartbeat_; }
  std::uint32_t type() const { return type_; }

  /** Nothing on a sensor card. */
  const std::optional<Encoder>& encoder() const { return encoder_; }
  std::optional<Encoder>& encoder() { return encoder_; }

  /** Restarts the card: counter and heartbeat 0, amplifier off, nothing heard. */
  void restart(double position_counts);

  /** Unplugs the card, or plugs it, which restarts it. */
  void power(bool on, double position_counts);

  /** Spoils the next `count` frames; replaces what was still left of an earlier fault of the same way. */
  void spoil(FrameFault fault, std::uint32_t count);

  /** Ends spoiled frames, a stuck counter and power loss. */
  void clear_faults(double position_counts);

 private:
  std::optional<wire::Frame> spoiled(const wire::Frame& latched);
  void hear(wire::FrameView frame);

  std::uint32_t type_;
  std::optional<Encoder> encoder_;
  Random reading_noise_;
  Random bit_errors_;

  wire::MotorCommand command_;
  Microseconds silence_{0};
  Microseconds uptime_{0};
  std::uint32_t heartbeat_ = 0;
  std::optional<std::uint32_t> heard_tick_;
  bool watchdog_tripped_ = false;
  bool last_frame_bad_ = false;
  bool was_reset_ = false;
  bool powered_ = true;

  std::optional<wire::Frame> last_latched_;
  std::optional<wire::Frame> last_sent_;
  FrameFault fault_ = FrameFault::kCorrupt;
  std::uint32_t spoiled_left_ = 0;
  std::uint32_t deaf_left_ = 0;
};

}  // namespace interlock::plant

#endif
