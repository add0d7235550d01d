/**
 * @file
 * Names of the control protocol, the same in requests and answers.
 */
#ifndef INTERLOCK_PLANT_SIM_CHOICES_HPP
#define INTERLOCK_PLANT_SIM_CHOICES_HPP

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "plant/card.hpp"
#include "plant/record.hpp"

namespace interlock::plant::sim {

template <typename Value>
struct Choice {
  std::string_view name;
  Value value;
};

inline constexpr std::array kContacts = {Choice<bool>{"no", true}, Choice<bool>{"nc", false}};

inline constexpr std::array kContactStates = {Choice<std::optional<bool>>{"free", std::nullopt},
                                              Choice<std::optional<bool>>{"open", false},
                                              Choice<std::optional<bool>>{"closed", true}};

inline constexpr std::array kEncoderStates = {Choice<bool>{"normal", false}, Choice<bool>{"stuck", true}};

inline constexpr std::array kSwitchStates = {Choice<std::optional<bool>>{"normal", std::nullopt},
                                             Choice<std::optional<bool>>{"open", false},
                                             Choice<std::optional<bool>>{"triggered", true}};

inline constexpr std::array kFrameFaults = {
    Choice<FrameFault>{"corrupt", FrameFault::kCorrupt}, Choice<FrameFault>{"drop", FrameFault::kDrop},
    Choice<FrameFault>{"delay", FrameFault::kDelay}, Choice<FrameFault>{"repeat", FrameFault::kRepeat},
    Choice<FrameFault>{"deaf", FrameFault::kDeaf}};

inline constexpr std::array kEvents = {Choice<Event>{"pedal_released", Event::kPedalReleased},
                                       Choice<Event>{"pedal_pressed", Event::kPedalPressed},
                                       Choice<Event>{"estop_pulled", Event::kEstopPulled},
                                       Choice<Event>{"estop_released", Event::kEstopReleased},
                                       Choice<Event>{"last_nonzero_drive", Event::kLastNonzeroDrive},
                                       Choice<Event>{"amplifiers_off", Event::kAmplifiersOff},
                                       Choice<Event>{"kernel_silent", Event::kKernelSilent}};
static_assert(kEvents.size() == kEventCount);

/** The name by which a command asks for that state. */
template <typename Value, std::size_t Size>
std::string_view name_of_state(const std::array<Choice<Value>, Size>& choices, const Value& value) {
  const auto found = std::find_if(choices.begin(), choices.end(),
                                  [&value](const Choice<Value>& choice) { return choice.value == value; });
  return found->name;
}

}  // namespace interlock::plant::sim

#endif
