#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "plant/sim/choices.hpp"
#include "plant/sim/protocol.hpp"

namespace interlock::plant::sim {
namespace {

using nlohmann::json;

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

const char* name_of_card(std::uint32_t card) {
  switch (static_cast<ilk_card_t>(card)) {
    case ILK_CARD_NONE:
      return "NONE";
    case ILK_CARD_PWM:
      return "PWM";
    case ILK_CARD_NON_PWM:
      return "NON_PWM";
    case ILK_CARD_ANALOG:
      return "ANALOG";
    case ILK_CARD_HIGH_FREQUENCY:
      return "HIGH_FREQUENCY";
    case ILK_CARD_SENSOR:
      return "SENSOR";
  }
  return "?";
}

const char* name_of_lamp(std::size_t lamp) {
  switch (static_cast<ilk_lamp_t>(lamp)) {
    case ILK_LAMP_PEDAL:
      return "pedal";
    case ILK_LAMP_NETWORK:
      return "network";
    case ILK_LAMP_CONTROLLER:
      return "controller";
    case ILK_LAMP_STALL:
      return "stall";
  }
  return "?";
}

const char* name_of_colour(std::uint32_t colour) {
  switch (static_cast<ilk_colour_t>(colour)) {
    case ILK_COLOUR_OFF:
      return "OFF";
    case ILK_COLOUR_GREEN:
      return "GREEN";
    case ILK_COLOUR_RED:
      return "RED";
    case ILK_COLOUR_AMBER:
      return "AMBER";
    case ILK_COLOUR_PURPLE:
      return "PURPLE";
  }
  return "?";
}

double thousandths(double value) { return std::round(value * 1000) / 1000; }

json card_status(std::size_t slot, const Card& card) {
  return {{"slot", slot},
          {"type", name_of_card(card.type())},
          {"powered", card.is_powered()},
          {"amplifier", card.amplifier_on()},
          {"watchdog_tripped", card.watchdog_tripped()},
          {"was_reset", card.was_reset()},
          {"heartbeat", card.heartbeat()}};
}

json parameters_status(const AxisParameters& axis) {
  json parameters{{"coast_counts", thousandths(coast_counts(axis))}};
  for (const AxisKnob& knob : kAxisKnobs) {
    parameters[std::string(knob.name)] = knob.get(axis);
  }
  return parameters;
}

json axis_status(std::size_t slot, const Station& station, std::uint32_t drive, Microseconds period) {
  const Axis& axis = *station.axis;
  const double counts_per_tick =
      axis.runaway_counts_per_s().value_or(0) * static_cast<double>(period.count()) * 1e-6;
  return {{"slot", slot},
          {"name", axis.name()},
          {"position_counts", thousandths(axis.position_counts())},
          {"tool_counts", thousandths(axis.tool_counts())},
          {"speed_counts_per_s", thousandths(axis.speed_counts_per_s())},
          {"drive", drive},
          {"counts", static_cast<std::int32_t>(station.card.encoder()->count(axis.position_counts()))},
          {"has_switch", station.has_switch},
          {"switch_triggered", axis.limit_switch().triggered()},
          {"jammed", axis.is_jammed()},
          {"counts_per_tick", thousandths(counts_per_tick)},
          {"reversed", axis.is_reversed()},
          {"encoder", name_of_state(kEncoderStates, station.card.encoder()->is_stuck())},
          {"switch", name_of_state(kSwitchStates, axis.limit_switch().stuck())},
          {"parameters", parameters_status(axis.parameters())},
          {"parameters_changed", axis.parameters() != axis.file_parameters()}};
}

json sensor_status(std::size_t slot, const ForceSensor& sensor) {
  json inputs = json::array();
  for (std::size_t input = 0; input < wire::kAnalogInputs; ++input) {
    if (sensor.is_connected(input)) {
      inputs.push_back({{"adc", input + 1},
                        {"counts", sensor.counts(input)},
                        {"force_counts", sensor.force_counts(input)}});
    }
  }
  return {{"slot", slot}, {"name", sensor.name()}, {"inputs", inputs}};
}

json needle_status(const Surroundings& surroundings) {
  const NeedleTruth truth = surroundings.truth();
  return {{"depth_mm", truth.depth_mm},
          {"tip_mm", truth.tip_mm},
          {"target_mm", truth.target_mm},
          {"hand_n", truth.hand_n},
          {"needle_n", truth.needle_n},
          {"punctures_mm", std::vector<double>(truth.punctures_mm.begin(), truth.punctures_mm.end())}};
}

template <typename Values>
void append_list(std::string& text, const char* name, const Values& values) {
  text += ",\"";
  text += name;
  text += "\":[";
  for (std::size_t index = 0; index < values.size(); ++index) {
    std::array<char, 24> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), values[index]).ptr;
    if (index > 0) {
      text += ',';
    }
    text.append(digits.data(), end);
  }
  text += ']';
}

void append_flag(std::string& text, const char* name, bool value) {
  text += ",\"";
  text += name;
  text += value ? "\":true" : "\":false";
}

void append_entry(std::string& text, const RecordEntry& entry) {
  std::array<std::int32_t, ILK_SLOTS> counts;
  std::transform(entry.counter.begin(), entry.counter.end(), counts.begin(),
                 [](std::uint32_t counter) { return static_cast<std::int32_t>(counter); });
  std::array<int, ILK_SLOTS> amplifier;
  std::copy(entry.amplifier.begin(), entry.amplifier.end(), amplifier.begin());
  text += "{\"tick\":" + std::to_string(entry.tick) + ",\"kernel_tick\":" + std::to_string(entry.kernel_tick);
  append_flag(text, "pedal_no", entry.pedal_no_closed);
  append_flag(text, "pedal_nc", entry.pedal_nc_closed);
  append_flag(text, "estop_loop", entry.estop_loop_closed);
  append_list(text, "drive", entry.drive);
  append_list(text, "amplifier", amplifier);
  append_list(text, "counts", counts);
  text += '}';
}

}  // namespace

std::string accepted(const json& id, std::uint64_t tick, json more) {
  if (!id.is_null()) {
    more["id"] = id;
  }
  more["ok"] = true;
  more["tick"] = tick;
  return text_of(more) + '\n';
}

std::string refused(const Refusal& refusal) {
  json answer{{"ok", false}, {"error", refusal.reason}};
  if (!refusal.id.is_null()) {
    answer["id"] = refusal.id;
  }
  return text_of(answer) + '\n';
}

json status_of(const Plant& plant, std::optional<ilk_clock_t> clock) {
  const Record& record = plant.record();
  const RecordEntry newest = record.end() == 0
                                 ? RecordEntry{.pedal_no_closed = plant.pedal().normally_open().closed(),
                                               .pedal_nc_closed = plant.pedal().normally_closed().closed(),
                                               .estop_loop_closed = !plant.estop_pulled()}
                                 : record[record.end() - 1];
  json lamps = json::object();
  for (std::size_t lamp = 0; lamp < ILK_LAMP_COUNT; ++lamp) {
    lamps[name_of_lamp(lamp)] = name_of_colour(plant.lamps()[lamp]);
  }
  json axes = json::array();
  json sensors = json::array();
  json cards = json::array();
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (const auto& station = plant.station(slot)) {
      cards.push_back(card_status(slot, station->card));
      if (station->axis) {
        axes.push_back(axis_status(slot, *station, newest.drive[slot], plant.period()));
      }
      if (station->sensor) {
        sensors.push_back(sensor_status(slot, *station->sensor));
      }
    }
  }
  json kernel{{"attached", clock.has_value()}, {"tick", newest.kernel_tick}, {"clock", nullptr}};
  if (clock) {
    kernel["clock"] = *clock == ILK_CLOCK_SIM ? "sim" : "real";
  }
  json status{{"kernel", kernel},
              {"pedal",
               {{"pressed", plant.pedal().is_pressed()},
                {"no_closed", newest.pedal_no_closed},
                {"nc_closed", newest.pedal_nc_closed},
                {"no", name_of_state(kContactStates, plant.pedal().normally_open().stuck())},
                {"nc", name_of_state(kContactStates, plant.pedal().normally_closed().stuck())}}},
              {"estop", {{"pulled", plant.estop_pulled()}, {"loop_closed", newest.estop_loop_closed}}},
              {"power", plant.power()},
              {"lamps", lamps},
              {"axes", axes},
              {"sensors", sensors},
              {"cards", cards}};
  if (const Surroundings* surroundings = plant.surroundings()) {
    status["needle"] = needle_status(*surroundings);
  }
  return status;
}

json image_of(const Plant& plant) {
  const Surroundings* surroundings = plant.surroundings();
  if (surroundings == nullptr || !surroundings->newest_image()) {
    return {{"image", nullptr}};
  }
  const TipImage& image = *surroundings->newest_image();
  const double now_s = static_cast<double>(plant.time().count()) * 1e-6;
  return {{"image",
           {{"time_s", image.time_s},
            {"age_s", now_s - image.time_s},
            {"tip_mm", image.tip_mm},
            {"target_mm", image.target_mm}}}};
}

json newest_of(const Plant& plant, Event kind) {
  const auto tick = plant.record().newest(kind);
  return {{"event_tick", tick ? json(*tick) : json(nullptr)}};
}

RecordAnswer::RecordAnswer(const json& id, const Plant& plant, const RecordQuery& query)
    : next_(plant.record().find(query.from)), end_(plant.record().find(query.to + 1)) {
  const Record& record = plant.record();
  json more = json::object();
  if (end_ - next_ > kMostEntries) {
    // Whole ticks only: in the real clock a tick can hold more than one exchange.
    const std::uint64_t next_tick = record[next_ + kMostEntries].tick;
    end_ = record.find(next_tick);
    more["next"] = next_tick;
  }
  if (record.end() > 0) {
    more["oldest"] = record[record.begin()].tick;
  }
  head_ = accepted(id, plant.ticks(), more);
  head_.resize(head_.size() - 2);
  head_ += ",\"entries\":[";
}

bool RecordAnswer::append(const Record& record, std::uint64_t most, std::string& text) {
  text += std::exchange(head_, {});
  const std::uint64_t stop = std::min(end_, next_ + most);
  for (; next_ < stop; ++next_) {
    append_entry(text, record[next_]);
    if (next_ + 1 < end_) {
      text += ',';
    }
  }
  if (next_ < end_) {
    return false;
  }
  text += "]}\n";
  return true;
}

}  // namespace interlock::plant::sim
