#include "oracle/wire.hpp"

#include <array>

namespace interlock::oracle::wire {
namespace {

constexpr std::uint32_t kStartWord = 0xFEFEFE01u;
constexpr std::uint32_t kSwitchOpen = 0x00080000u; /**< in word 2 of an incoming frame; 0 when triggered */
constexpr std::uint32_t kPwmNotActual = 0x80000000u;
constexpr std::uint32_t kPwmLargest = 0x7FFFFFFFu;
constexpr std::uint32_t kNonPwmActual = 0x40000000u;
constexpr std::uint32_t kNonPwmNotActual = 0xC0000000u;
constexpr std::uint32_t kNonPwmLargest = 0x3FFFFFFFu;

constexpr std::uint32_t kSlowestWord = 1196612456u;
constexpr std::uint32_t kWordStep = 4063228u;
constexpr std::array<std::uint32_t, 24> kSpeeds = {
    0,     54,    189,   331,   614,   1095,  2020,   3222,   3773,   6383,   11445,  15308,
    20955, 27358, 36039, 45548, 58997, 78710, 105850, 141386, 188106, 247388, 317394, 397785};

/** The published setDirection is 1 for decreasing positions; a motor direction of 0 inverts it on the wire.
 */
bool bit_when_rising(const AxisRules& axis) { return !axis.motor_direction; }

Drive read_signal(const AxisRules& axis, bool actual, std::uint32_t magnitude, bool well_formed) {
  return {well_formed && magnitude > 0, actual == bit_when_rising(axis), magnitude, 0};
}

}  // namespace

bool is_intact(FrameView frame) noexcept {
  std::uint32_t sum = 0;
  for (const std::uint32_t word : frame.first(frame.size() - 1)) {
    sum += word;
  }
  return frame[0] == kStartWord && frame.back() == 0xFFFFFFFFu - sum;
}

Reading read(FrameView frame) noexcept {
  return {frame[3], frame[9], frame[11], (frame[2] & kSwitchOpen) == 0};
}

std::uint32_t tick_counter(FrameView frame) noexcept { return frame[13]; }

bool is_zero_drive(FrameView frame) noexcept {
  return (frame[2] | frame[3] | frame[4] | frame[5] | frame[6] | frame[14]) == 0;
}

Drive read_drive(const AxisRules& axis, FrameView frame) noexcept {
  const bool amplifier = frame[14] == 1;
  const bool signal_only = (frame[2] | frame[4] | frame[5]) == 0;
  switch (axis.card) {
    case CardKind::kPwm:
      return read_signal(axis, (frame[3] & kPwmNotActual) == 0, frame[3] & kPwmLargest,
                         amplifier && signal_only && frame[6] == 0);
    case CardKind::kNonPwm: {
      const std::uint32_t sense = frame[3] & ~kNonPwmLargest;
      return read_signal(
          axis, sense == kNonPwmActual, frame[3] & kNonPwmLargest,
          amplifier && signal_only && frame[6] == 0 && (sense == kNonPwmActual || sense == kNonPwmNotActual));
    }
    case CardKind::kAnalog:
      return read_signal(axis, (frame[6] & kPwmNotActual) == 0, frame[6] & kPwmLargest,
                         amplifier && (frame[2] | frame[3] | frame[4] | frame[5]) == 0);
    case CardKind::kHighFrequency: {
      const std::uint32_t first = frame[2] >> 24;
      const std::uint32_t second = frame[4] >> 24;
      const std::uint32_t amplitude = frame[2] & 0xFFu;
      Drive drive = read_signal(axis, second == 1, frame[3],
                                amplifier && frame[3] == frame[5] && frame[6] == 0 && first + second == 1 &&
                                    amplitude == (frame[4] & 0xFFu) && (frame[2] & 0x00FFFF00u) == 0 &&
                                    (frame[4] & 0x00FFFF00u) == 0);
      drive.amplitude = amplitude;
      return drive;
    }
    case CardKind::kNone:
    case CardKind::kSensor:
    default:
      return {};
  }
}

std::uint32_t frequency_word(std::uint32_t drive) noexcept {
  std::uint32_t slower = 0;
  while (slower + 2 < kSpeeds.size() && drive >= kSpeeds[slower + 1]) {
    slower++;
  }
  const std::uint32_t word = kSlowestWord - kWordStep * slower;
  if (drive >= kSpeeds.back()) {
    return word - kWordStep;
  }
  const std::uint64_t part = std::uint64_t{kWordStep} * (drive - kSpeeds[slower]);
  return word - static_cast<std::uint32_t>(part / (kSpeeds[slower + 1] - kSpeeds[slower]));
}

bool exceeds(CardKind card, const Drive& drive, std::uint32_t bound) noexcept {
  return card == CardKind::kHighFrequency ? drive.magnitude < frequency_word(bound) : drive.magnitude > bound;
}

}  // namespace interlock::oracle::wire
