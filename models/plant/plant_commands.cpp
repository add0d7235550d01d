#include <concepts>
#include <type_traits>

#include "plant/plant.hpp"

namespace interlock::plant {
namespace {

/** A push takes so many periods. */
constexpr std::uint64_t kPushTicks = 100;

template <typename Wish>
concept NamesSlot = requires(const Wish& wish) {
  { wish.slot } -> std::same_as<const std::size_t&>;
};

/** True when the wish needs an axis on the card. */
template <typename Wish>
constexpr bool kNeedsAxis =
    !std::is_same_v<Wish, command::ResetCard> && !std::is_same_v<Wish, command::PowerCard> &&
    !std::is_same_v<Wish, command::PressSensor>;

constexpr const char* kNoNeedle = "the plant file has no [needle]";

std::string slot_text(std::size_t slot) { return "slot " + std::to_string(slot); }

std::optional<std::string> sensor_refusal(const std::optional<ForceSensor>& sensor,
                                          const command::PressSensor& wish) {
  if (!sensor) {
    return slot_text(wish.slot) + " has a motor card, no force sensor";
  }
  if (!sensor->is_connected(wish.input)) {
    return "nothing is connected to ADC " + std::to_string(wish.input + 1) + " of " + slot_text(wish.slot);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> Plant::refusal(const command::Command& command) const {
  const auto refuse_slot = [this](std::size_t slot, bool needs_axis,
                                  bool needs_switch) -> std::optional<std::string> {
    if (slot >= ILK_SLOTS || !stations_[slot]) {
      return slot_text(slot) + " has no card";
    }
    if (needs_axis && !stations_[slot]->axis) {
      return slot_text(slot) + " has a sensor card, no axis";
    }
    if (needs_switch && !stations_[slot]->has_switch) {
      return slot_text(slot) + " has an axis without a limit switch";
    }
    return std::nullopt;
  };
  return std::visit(
      [&]<typename Wish>(const Wish& wish) -> std::optional<std::string> {
        if constexpr (std::is_same_v<Wish, command::PressSensor>) {
          const auto reason = refuse_slot(wish.slot, false, false);
          return reason ? reason : sensor_refusal(stations_[wish.slot]->sensor, wish);
        } else if constexpr (NamesSlot<Wish>) {
          return refuse_slot(wish.slot, kNeedsAxis<Wish>, std::is_same_v<Wish, command::StickSwitch>);
        } else if constexpr (std::is_same_v<Wish, command::SpoilFrames>) {
          return wish.slot ? refuse_slot(*wish.slot, false, false) : std::nullopt;
        } else if constexpr (std::is_same_v<Wish, command::PressHand> ||
                             std::is_same_v<Wish, command::ShiftTarget>) {
          return surroundings_ ? std::nullopt : std::optional<std::string>(kNoNeedle);
        } else {
          return std::nullopt;
        }
      },
      command);
}

tl::expected<std::uint64_t, std::string> Plant::schedule(const command::Command& command,
                                                         std::optional<std::uint64_t> at) {
  if (const auto reason = refusal(command)) {
    return tl::unexpected(*reason);
  }
  const std::uint64_t tick = at.value_or(ticks());
  if (tick < ticks()) {
    return tl::unexpected(past_text(tick));
  }
  if (schedule_.is_full()) {
    return tl::unexpected(std::to_string(Schedule::kCapacity) +
                          " commands already wait for their tick; send this one later");
  }
  schedule_.add(tick, command);
  return tick;
}

std::string Plant::past_text(std::uint64_t at) const {
  return "'at' " + std::to_string(at) + " is past; the plant is at tick " + std::to_string(ticks());
}

void Plant::run_due_commands() {
  while (const auto due = schedule_.take_due(ticks())) {
    std::visit([this](const auto& wish) { apply(wish); }, *due);
  }
  note_amplifiers();
}

void Plant::apply(const command::PressPedal& wish) { pedal_.press(wish.pressed); }

void Plant::apply(const command::StickPedalContact& wish) {
  (wish.normally_open ? pedal_.normally_open() : pedal_.normally_closed()).stick(wish.closed);
}

void Plant::apply(const command::PullEstop& wish) { estop_loop_.move(!wish.pulled); }

void Plant::apply(const command::JamAxis& wish) { stations_[wish.slot]->axis->jam(wish.jammed); }

void Plant::apply(const command::PushAxis& wish) {
  stations_[wish.slot]->axis->push(wish.counts, period_ * kPushTicks);
}

void Plant::apply(const command::JumpCounter& wish) {
  stations_[wish.slot]->card.encoder()->jump(wish.counts);
}

void Plant::apply(const command::RunAway& wish) {
  const double counts_per_s = wish.counts_per_tick * 1e6 / static_cast<double>(period_.count());
  stations_[wish.slot]->axis->run_away(counts_per_s != 0 ? std::optional(counts_per_s) : std::nullopt);
}

void Plant::apply(const command::ReverseMotor& wish) { stations_[wish.slot]->axis->reverse(wish.reversed); }

void Plant::apply(const command::StickEncoder& wish) {
  Station& station = *stations_[wish.slot];
  station.card.encoder()->stick(wish.stuck, station.position_counts());
}

void Plant::apply(const command::StickSwitch& wish) {
  stations_[wish.slot]->axis->limit_switch().stick(wish.triggered);
}

void Plant::apply(const command::ChangeParameters& wish) {
  Station& station = *stations_[wish.slot];
  AxisParameters changed = station.axis->parameters();
  for (std::size_t knob = 0; knob < kAxisKnobCount; ++knob) {
    if (wish.value[knob]) {
      kAxisKnobs[knob].set(changed, *wish.value[knob]);
    }
  }
  station.take(changed);
}

void Plant::apply(const command::RestoreParameters& wish) {
  Station& station = *stations_[wish.slot];
  station.take(station.axis->file_parameters());
}

void Plant::apply(const command::PressSensor& wish) {
  stations_[wish.slot]->sensor->press(wish.input, wish.counts);
}

void Plant::apply(const command::SpoilFrames& wish) {
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (stations_[slot] && wish.slot.value_or(slot) == slot) {
      stations_[slot]->card.spoil(wish.fault, wish.count);
    }
  }
}

void Plant::apply(const command::ResetCard& wish) {
  Station& station = *stations_[wish.slot];
  station.card.restart(station.position_counts());
}

void Plant::apply(const command::PowerCard& wish) {
  Station& station = *stations_[wish.slot];
  station.card.power(wish.on, station.position_counts());
}

void Plant::apply(const command::FailTransactions& wish) { failing_transactions_ = wish.count; }

void Plant::apply(const command::PressHand& wish) { surroundings_->press_hand(wish.force_n); }

void Plant::apply(const command::ShiftTarget& wish) { surroundings_->shift_target(wish.by_mm); }

void Plant::apply(const command::Clear&) {
  if (surroundings_) {
    surroundings_->press_hand(0.0);
  }
  pedal_.normally_open().stick(std::nullopt);
  pedal_.normally_closed().stick(std::nullopt);
  failing_transactions_ = 0;
  for (auto& station : stations_) {
    if (station) {
      station->card.clear_faults(station->position_counts());
      if (station->axis) {
        station->axis->clear_faults();
      }
      if (station->sensor) {
        station->sensor->release();
      }
    }
  }
}

}  // namespace interlock::plant
