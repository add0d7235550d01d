#include "plant/sim/protocol.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <vector>

namespace interlock::plant::sim {
namespace {

using nlohmann::json;

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

template <typename Value>
struct Choice {
  std::string_view name;
  Value value;
};

/** Takes the fields of one request and keeps the first fault. */
class Fields {
 public:
  explicit Fields(const json& object) : object_(object) {}

  const std::string& fault() const { return fault_; }

  bool flag(const char* name) {
    const json* value = take(name);
    if (value == nullptr || !value->is_boolean()) {
      return fail(name, "expected true or false"), false;
    }
    return value->get<bool>();
  }

  std::int64_t integer(const char* name, std::int64_t least, std::int64_t most) {
    const json* value = take(name);
    const bool fits = value != nullptr && value->is_number_integer() &&
                      !(value->is_number_unsigned() && value->get<std::uint64_t>() > kMostInteger);
    if (!fits || value->get<std::int64_t>() < least || value->get<std::int64_t>() > most) {
      return fail(name,
                  "expected a whole number from " + std::to_string(least) + " to " + std::to_string(most)),
             least;
    }
    return value->get<std::int64_t>();
  }

  double number(const char* name, double most) {
    const json* value = take(name);
    if (value == nullptr || !value->is_number() || !(std::abs(value->get<double>()) <= most)) {
      return fail(name, "expected a number from " + text_of(-most) + " to " + text_of(most)), 0;
    }
    return value->get<double>();
  }

  std::uint64_t tick(const char* name) { return static_cast<std::uint64_t>(integer(name, 0, kMostInteger)); }

  std::size_t slot() { return static_cast<std::size_t>(integer("slot", 0, ILK_SLOTS - 1)); }

  std::uint32_t count() { return static_cast<std::uint32_t>(integer("count", 1, command::kMostFrames)); }

  std::int32_t counts() {
    return static_cast<std::int32_t>(integer("counts", -command::kMostCounts, command::kMostCounts));
  }

  template <typename Value, std::size_t Size>
  Value choice(const char* name, const std::array<Choice<Value>, Size>& choices) {
    const json* value = take(name);
    std::string names;
    for (const Choice<Value>& one : choices) {
      if (value != nullptr && value->is_string() && value->get_ref<const std::string&>() == one.name) {
        return one.value;
      }
      names += (names.empty() ? "" : ", ") + std::string(one.name);
    }
    return fail(name, "expected one of " + names), choices[0].value;
  }

  bool has(const char* name) const { return object_.contains(name); }

  bool is(const char* name, const char* text) const { return has(name) && object_[name] == text; }

  const json* take(const char* name) {
    taken_.emplace_back(name);
    const auto found = object_.find(name);
    return found == object_.end() ? nullptr : &*found;
  }

  /** Fails when a field was not taken. */
  void no_more() {
    for (const auto& [name, value] : object_.items()) {
      if (std::find(taken_.begin(), taken_.end(), name) == taken_.end()) {
        std::string names;
        for (const std::string_view one : taken_) {
          names += (names.empty() ? "" : ", ") + std::string(one);
        }
        fail(name, "unknown field; this command takes " + names);
      }
    }
  }

  void fail(const std::string& name, const std::string& expected) {
    if (fault_.empty()) {
      fault_ = "'" + name + "': " + expected;
    }
  }

 private:
  static constexpr std::int64_t kMostInteger = std::int64_t{1} << 53;

  const json& object_;
  std::vector<std::string_view> taken_;
  std::string fault_;
};

constexpr std::array kContacts = {Choice<bool>{"no", true}, Choice<bool>{"nc", false}};

constexpr std::array kContactStates = {Choice<std::optional<bool>>{"free", std::nullopt},
                                       Choice<std::optional<bool>>{"open", false},
                                       Choice<std::optional<bool>>{"closed", true}};

constexpr std::array kEncoderStates = {Choice<bool>{"normal", false}, Choice<bool>{"stuck", true}};

constexpr std::array kSwitchStates = {Choice<std::optional<bool>>{"normal", std::nullopt},
                                      Choice<std::optional<bool>>{"open", false},
                                      Choice<std::optional<bool>>{"triggered", true}};

constexpr std::array kFrameFaults = {
    Choice<FrameFault>{"corrupt", FrameFault::kCorrupt}, Choice<FrameFault>{"drop", FrameFault::kDrop},
    Choice<FrameFault>{"delay", FrameFault::kDelay}, Choice<FrameFault>{"repeat", FrameFault::kRepeat},
    Choice<FrameFault>{"deaf", FrameFault::kDeaf}};

constexpr std::array kEvents = {Choice<Event>{"pedal_released", Event::kPedalReleased},
                                Choice<Event>{"pedal_pressed", Event::kPedalPressed},
                                Choice<Event>{"estop_pulled", Event::kEstopPulled},
                                Choice<Event>{"estop_released", Event::kEstopReleased},
                                Choice<Event>{"last_nonzero_drive", Event::kLastNonzeroDrive},
                                Choice<Event>{"amplifiers_off", Event::kAmplifiersOff},
                                Choice<Event>{"kernel_silent", Event::kKernelSilent}};
static_assert(kEvents.size() == kEventCount);

command::SpoilFrames read_frame_fault(Fields& fields) {
  std::optional<std::size_t> slot;
  if (fields.is("slot", "all")) {
    fields.take("slot");
  } else {
    slot = fields.slot();
  }
  return {slot, fields.choice("fault", kFrameFaults), fields.count()};
}

RecordQuery read_range(Fields& fields) {
  const RecordQuery query{fields.tick("from"), fields.tick("to")};
  if (query.to < query.from) {
    fields.fail("to", "expected a tick not before 'from'");
  }
  return query;
}

/** Braces evaluate from left to right, so that the first fault named is that of the first field. */
struct Form {
  std::string_view name;
  Wish (*read)(Fields&);
};

constexpr std::array kForms = {
    Form{"pedal", [](Fields& f) -> Wish { return command::PressPedal{f.flag("pressed")}; }},
    Form{"pedal_contact",
         [](Fields& f) -> Wish {
           return command::StickPedalContact{f.choice("contact", kContacts),
                                             f.choice("state", kContactStates)};
         }},
    Form{"estop", [](Fields& f) -> Wish { return command::PullEstop{f.flag("pulled")}; }},
    Form{"jam", [](Fields& f) -> Wish { return command::JamAxis{f.slot(), f.flag("jammed")}; }},
    Form{"push", [](Fields& f) -> Wish { return command::PushAxis{f.slot(), f.counts()}; }},
    Form{"jump", [](Fields& f) -> Wish { return command::JumpCounter{f.slot(), f.counts()}; }},
    Form{"runaway",
         [](Fields& f) -> Wish {
           return command::RunAway{f.slot(), f.number("counts_per_tick", command::kMostCountsPerTick)};
         }},
    Form{"reverse", [](Fields& f) -> Wish { return command::ReverseMotor{f.slot(), f.flag("reversed")}; }},
    Form{
        "encoder",
        [](Fields& f) -> Wish { return command::StickEncoder{f.slot(), f.choice("state", kEncoderStates)}; }},
    Form{"switch",
         [](Fields& f) -> Wish { return command::StickSwitch{f.slot(), f.choice("state", kSwitchStates)}; }},
    Form{"frame", [](Fields& f) -> Wish { return read_frame_fault(f); }},
    Form{"card_reset", [](Fields& f) -> Wish { return command::ResetCard{f.slot()}; }},
    Form{"card_power", [](Fields& f) -> Wish { return command::PowerCard{f.slot(), f.flag("on")}; }},
    Form{"transaction", [](Fields& f) -> Wish { return command::FailTransactions{f.count()}; }},
    Form{"clear", [](Fields&) -> Wish { return command::Clear{}; }},
    Form{"status", [](Fields&) -> Wish { return StatusQuery{}; }},
    Form{"record", [](Fields& f) -> Wish { return read_range(f); }},
    Form{"record_event", [](Fields& f) -> Wish { return EventQuery{f.choice("kind", kEvents)}; }},
};

const Form* find_form(const json& name) {
  const auto found = std::find_if(kForms.begin(), kForms.end(), [&name](const Form& form) {
    return name.is_string() && name.get_ref<const std::string&>() == form.name;
  });
  return found == kForms.end() ? nullptr : found;
}

std::string form_names() {
  std::string names;
  for (const Form& form : kForms) {
    names += (names.empty() ? "" : ", ") + std::string(form.name);
  }
  return names;
}

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

/** The name by which a command asks for that state. */
template <typename Value, std::size_t Size>
std::string_view name_of_state(const std::array<Choice<Value>, Size>& choices, const Value& value) {
  const auto found = std::find_if(choices.begin(), choices.end(),
                                  [&value](const Choice<Value>& choice) { return choice.value == value; });
  return found->name;
}

json axis_status(std::size_t slot, const Station& station, std::uint32_t drive, Microseconds period) {
  const Axis& axis = *station.axis;
  const double counts_per_tick =
      axis.runaway_counts_per_s().value_or(0) * static_cast<double>(period.count()) * 1e-6;
  return {{"slot", slot},
          {"name", axis.name()},
          {"position_counts", thousandths(axis.position_counts())},
          {"speed_counts_per_s", thousandths(axis.speed_counts_per_s())},
          {"drive", drive},
          {"counts", static_cast<std::int32_t>(station.card.encoder()->count(axis.position_counts()))},
          {"has_switch", station.has_switch},
          {"switch_triggered", axis.limit_switch().triggered()},
          {"jammed", axis.is_jammed()},
          {"counts_per_tick", thousandths(counts_per_tick)},
          {"reversed", axis.is_reversed()},
          {"encoder", name_of_state(kEncoderStates, station.card.encoder()->is_stuck())},
          {"switch", name_of_state(kSwitchStates, axis.limit_switch().stuck())}};
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

tl::expected<Request, Refusal> parse_request(std::string_view line, std::uint64_t now) {
  const json object = json::parse(line, nullptr, false);
  if (!object.is_object()) {
    return tl::unexpected(
        Refusal{nullptr, "expected one JSON object a line, such as {\"command\":\"status\"}"});
  }
  Fields fields(object);
  Request request;
  if (const json* id = fields.take("id")) {
    request.id = *id;
  }
  const json* name = fields.take("command");
  const Form* form = name == nullptr ? nullptr : find_form(*name);
  if (form == nullptr) {
    return tl::unexpected(Refusal{request.id, "'command': expected one of " + form_names()});
  }
  request.wish = form->read(fields);
  if (fields.has("at")) {
    request.at = fields.tick("at");
  } else if (fields.has("after")) {
    request.at = now + fields.tick("after");
  }
  fields.no_more();
  if (!fields.fault().empty()) {
    return tl::unexpected(Refusal{request.id, std::string(form->name) + ": " + fields.fault()});
  }
  return request;
}

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
  json cards = json::array();
  for (std::size_t slot = 0; slot < ILK_SLOTS; ++slot) {
    if (const auto& station = plant.station(slot)) {
      cards.push_back(card_status(slot, station->card));
      if (station->axis) {
        axes.push_back(axis_status(slot, *station, newest.drive[slot], plant.period()));
      }
    }
  }
  json kernel{{"attached", clock.has_value()}, {"tick", newest.kernel_tick}, {"clock", nullptr}};
  if (clock) {
    kernel["clock"] = *clock == ILK_CLOCK_SIM ? "sim" : "real";
  }
  return {{"kernel", kernel},
          {"pedal",
           {{"pressed", plant.pedal().is_pressed()},
            {"no_closed", newest.pedal_no_closed},
            {"nc_closed", newest.pedal_nc_closed},
            {"no", name_of_state(kContactStates, plant.pedal().normally_open().stuck())},
            {"nc", name_of_state(kContactStates, plant.pedal().normally_closed().stuck())}}},
          {"estop", {{"pulled", plant.estop_pulled()}, {"loop_closed", newest.estop_loop_closed}}},
          {"lamps", lamps},
          {"axes", axes},
          {"cards", cards}};
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
