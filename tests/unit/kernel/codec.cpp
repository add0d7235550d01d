#include "codec.hpp"

#include <algorithm>
#include <numeric>

namespace interlock::kernel_test {

namespace {

constexpr std::array<uint32_t, 24> high_frequency_speeds = {
    0,     54,    189,   331,   614,   1095,  2020,   3222,   3773,   6383,   11445,  15308,
    20955, 27358, 36039, 45548, 58997, 78710, 105850, 141386, 188106, 247388, 317394, 397785};
constexpr uint32_t slowest_word = 1196612456u;
constexpr uint32_t word_step = 4063228u;

bool actual_bit(const ilk_axis_config_t& axis, uint32_t direction) {
  const bool set_direction = direction == ILK_DIRECTION_DECREASING;
  return axis.motor_direction == 1 ? set_direction : !set_direction;
}

}  // namespace

uint32_t checksum(std::span<const uint32_t> frame) {
  const auto words = frame.first(frame.size() - 1);
  return 0xFFFFFFFFu - std::accumulate(words.begin(), words.end(), 0u);
}

void write_checksum(std::span<uint32_t> frame) { frame.back() = checksum(frame); }

bool start_and_checksum_right(std::span<const uint32_t> frame) {
  return frame.front() == start_word && frame.back() == checksum(frame);
}

bool drive_words_zero(std::span<const uint32_t> frame) {
  const auto waves = frame.subspan(2, 5);
  return std::all_of(waves.begin(), waves.end(), [](uint32_t word) { return word == 0; }) &&
         frame[outgoing::amplifier] == 0;
}

ilk_direction_t wire_direction(const ilk_axis_config_t& axis, std::span<const uint32_t> frame) {
  if (drive_words_zero(frame)) return ILK_DIRECTION_NONE;
  bool actual = false;
  switch (axis.card) {
    case ILK_CARD_PWM:
      actual = (frame[3] & 0x80000000u) == 0;
      break;
    case ILK_CARD_NON_PWM:
      actual = (frame[3] & 0x80000000u) == 0;
      break;
    case ILK_CARD_ANALOG:
      actual = (frame[6] & 0x80000000u) == 0;
      break;
    case ILK_CARD_HIGH_FREQUENCY:
      actual = (frame[4] >> 24) == 1;
      break;
    default:
      return ILK_DIRECTION_NONE;
  }
  const bool decreasing = axis.motor_direction == 1 ? actual : !actual;
  return decreasing ? ILK_DIRECTION_DECREASING : ILK_DIRECTION_INCREASING;
}

uint32_t high_frequency_word(uint32_t drive) {
  if (drive >= high_frequency_speeds.back()) return slowest_word - word_step * 23;
  const auto above = std::upper_bound(high_frequency_speeds.begin(), high_frequency_speeds.end(), drive);
  const auto point = static_cast<uint32_t>(above - high_frequency_speeds.begin()) - 1;
  const uint64_t span = high_frequency_speeds[point + 1] - high_frequency_speeds[point];
  const uint64_t part = drive - high_frequency_speeds[point];
  return slowest_word - word_step * point - static_cast<uint32_t>(word_step * part / span);
}

Frame pack(const ilk_axis_config_t& axis, const ilk_command_t& command, uint32_t tick) {
  Frame frame{};
  frame[0] = start_word;
  frame[outgoing::tick] = tick;
  if (command.direction != ILK_DIRECTION_NONE && command.drive != 0) {
    const bool actual = actual_bit(axis, command.direction);
    switch (axis.card) {
      case ILK_CARD_PWM:
        frame[3] = (actual ? 0u : 0x80000000u) + command.drive;
        break;
      case ILK_CARD_NON_PWM:
        frame[3] = (actual ? 0x40000000u : 0xC0000000u) + command.drive;
        break;
      case ILK_CARD_ANALOG:
        frame[6] = (actual ? 0u : 0x80000000u) + command.drive;
        break;
      case ILK_CARD_HIGH_FREQUENCY:
        frame[2] = (actual ? 0u : 1u) << 24 | command.amplitude;
        frame[4] = (actual ? 1u : 0u) << 24 | command.amplitude;
        frame[3] = frame[5] = high_frequency_word(command.drive);
        break;
      default:
        break;
    }
    frame[outgoing::amplifier] = axis.card == ILK_CARD_NONE || axis.card == ILK_CARD_SENSOR ? 0 : 1;
  }
  write_checksum(frame);
  return frame;
}

uint32_t crc32_of_words(std::span<const uint32_t> words) {
  uint32_t crc = 0xFFFFFFFFu;
  for (const uint32_t word : words) {
    for (uint32_t bit = 0; bit < 32; ++bit) {
      const uint32_t low = (crc ^ (word >> bit)) & 1u;
      crc = (crc >> 1) ^ (low != 0 ? 0xEDB88320u : 0u);
    }
  }
  return ~crc;
}

}  // namespace interlock::kernel_test
