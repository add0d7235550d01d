#include "plant/wire.hpp"

namespace interlock::plant::wire {
namespace {

constexpr std::uint32_t kStartWord = 0xFEFEFE01u;

constexpr std::size_t kWave1 = 2;
constexpr std::size_t kWave1Frequency = 3;
constexpr std::size_t kWave2 = 4;
constexpr std::size_t kWave2Frequency = 5;
constexpr std::size_t kAnalogDrive = 6;
constexpr std::size_t kTickCounter = 13;
constexpr std::size_t kAmplifierEnable = 14;

constexpr std::size_t kPairs = 2;
constexpr std::size_t kCounter = 3;
constexpr std::size_t kAnalog12 = 7;
constexpr std::size_t kAnalog34 = 8;
constexpr std::size_t kHeartbeat = 9;
constexpr std::size_t kTime = 10;
constexpr std::size_t kTickEcho = 11;
constexpr std::size_t kStatus = 12;

constexpr std::size_t kChecksum = kFrameWords - 1;

constexpr std::uint32_t kSwitchOpenBit = 0x00080000u;
constexpr std::uint32_t kStatusAmplifier = 1u << 0;
constexpr std::uint32_t kStatusWatchdog = 1u << 1;
constexpr std::uint32_t kStatusBadFrame = 1u << 2;
constexpr std::uint32_t kStatusReset = 1u << 3;

constexpr std::uint32_t kTopBit = 0x80000000u;
constexpr std::uint32_t kNonPwmModeMask = 0xC0000000u;
constexpr std::uint32_t kNonPwmDirectionSet = 0x40000000u;
constexpr std::uint32_t kNonPwmDirectionClear = 0xC0000000u;

std::uint32_t two_halves(std::uint16_t upper, std::uint16_t lower) {
  return std::uint32_t{upper} << 16 | lower;
}

MotorCommand read_signed_level(std::uint32_t word) {
  return {.direction_bit = (word & kTopBit) == 0, .level = word & ~kTopBit};
}

MotorCommand read_non_pwm(std::uint32_t word) {
  const std::uint32_t mode = word & kNonPwmModeMask;
  if (mode != kNonPwmDirectionSet && mode != kNonPwmDirectionClear) {
    return {};
  }
  return {.direction_bit = mode == kNonPwmDirectionSet, .level = word & ~kNonPwmModeMask};
}

MotorCommand read_two_waves(FrameView frame) {
  const std::uint32_t table1 = frame[kWave1] >> 24;
  const std::uint32_t table2 = frame[kWave2] >> 24;
  const std::uint32_t amplitude = frame[kWave1] & 0xFFu;
  // Only two equal waves of opposite tables travel; any other pair stands still.
  const bool travelling = table1 <= 1 && table2 == 1 - table1 && amplitude == (frame[kWave2] & 0xFFu) &&
                          frame[kWave1Frequency] == frame[kWave2Frequency];
  if (!travelling) {
    return {};
  }
  return {.direction_bit = table1 == 0, .level = frame[kWave1Frequency], .amplitude = amplitude};
}

MotorCommand read_drive_words(std::uint32_t card, FrameView frame) {
  switch (card) {
    case ILK_CARD_PWM:
      return read_signed_level(frame[kWave1Frequency]);
    case ILK_CARD_NON_PWM:
      return read_non_pwm(frame[kWave1Frequency]);
    case ILK_CARD_ANALOG:
      return read_signed_level(frame[kAnalogDrive]);
    case ILK_CARD_HIGH_FREQUENCY:
      return read_two_waves(frame);
    default:
      return {};
  }
}

}  // namespace

std::uint32_t checksum(FrameView frame) {
  std::uint32_t sum = 0;
  for (const std::uint32_t word : frame.first<kChecksum>()) {
    sum += word;
  }
  return 0xFFFFFFFFu - sum;
}

bool is_sound(FrameView frame) { return frame[0] == kStartWord && frame[kChecksum] == checksum(frame); }

std::uint32_t tick_counter(FrameView frame) { return frame[kTickCounter]; }

std::uint32_t first_drive_word(FrameView frame) {
  for (const std::size_t word :
       {kWave1Frequency, kAnalogDrive, kWave1, kWave2, kWave2Frequency, kAmplifierEnable}) {
    if (frame[word] != 0) {
      return frame[word];
    }
  }
  return 0;
}

MotorCommand read_command(std::uint32_t card, FrameView frame) {
  MotorCommand command = read_drive_words(card, frame);
  command.amplifier_enabled = frame[kAmplifierEnable] != 0;
  return command;
}

Frame pack(const Report& report) {
  Frame frame{};
  frame[0] = kStartWord;
  frame[kPairs] = report.switch_triggered ? 0 : kSwitchOpenBit;
  frame[kCounter] = report.counter;
  frame[kAnalog12] = two_halves(report.analog[0], report.analog[1]);
  frame[kAnalog34] = two_halves(report.analog[2], report.analog[3]);
  frame[kHeartbeat] = report.heartbeat;
  frame[kTime] = report.time_us;
  frame[kTickEcho] = report.tick_echo;
  frame[kStatus] = (report.amplifier_on ? kStatusAmplifier : 0) |
                   (report.watchdog_tripped ? kStatusWatchdog : 0) |
                   (report.last_frame_bad ? kStatusBadFrame : 0) | (report.was_reset ? kStatusReset : 0);
  frame[kChecksum] = checksum(frame);
  return frame;
}

}  // namespace interlock::plant::wire
