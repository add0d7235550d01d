#include <algorithm>
#include <cmath>
#include <vector>

#include "plant/sim/choices.hpp"
#include "plant/sim/protocol.hpp"

namespace interlock::plant::sim {
namespace {

using nlohmann::json;

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
      return fail(name, "expected a number from " + json(-most).dump() + " to " + json(most).dump()), 0;
    }
    return value->get<double>();
  }

  /** Nothing when the field is not there. */
  std::optional<double> knob(const AxisKnob& knob) {
    const json* value = take(knob.name);
    if (value == nullptr) {
      return std::nullopt;
    }
    const bool is_number = knob.whole ? value->is_number_integer() : value->is_number();
    if (!is_number ||
        !(value->get<double>() >= knob.range.least && value->get<double>() <= knob.range.most)) {
      fail(std::string(knob.name), std::string(knob.whole ? "expected a whole number" : "expected a number") +
                                       " from " + json(knob.range.least).dump() + " to " +
                                       json(knob.range.most).dump());
    }
    return value->is_number() ? value->get<double>() : 0.0;
  }

  std::uint64_t tick(const char* name) { return static_cast<std::uint64_t>(integer(name, 0, kMostInteger)); }

  std::size_t slot() { return static_cast<std::size_t>(integer("slot", 0, ILK_SLOTS - 1)); }

  std::uint32_t count() { return static_cast<std::uint32_t>(integer("count", 1, command::kMostFrames)); }

  std::int32_t counts() {
    return static_cast<std::int32_t>(integer("counts", -command::kMostCounts, command::kMostCounts));
  }

  std::size_t analog_input() { return static_cast<std::size_t>(integer("adc", 1, wire::kAnalogInputs)) - 1; }

  std::array<double, 3> shift() {
    const json* value = take("by_mm");
    std::array<double, 3> by_mm{};
    bool fits = value != nullptr && value->is_array() && value->size() == by_mm.size();
    for (std::size_t place = 0; fits && place < by_mm.size(); ++place) {
      const json& number = (*value)[place];
      fits = number.is_number() && std::abs(number.get<double>()) <= command::kMostShift;
      by_mm[place] = fits ? number.get<double>() : 0.0;
    }
    if (!fits) {
      fail("by_mm", "expected three numbers from -100 to 100");
    }
    return by_mm;
  }

  std::int32_t force_counts() {
    return static_cast<std::int32_t>(
        integer("counts", -command::kMostForceCounts, command::kMostForceCounts));
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

  const json* take(std::string_view name) {
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

command::SpoilFrames read_frame_fault(Fields& fields) {
  std::optional<std::size_t> slot;
  if (fields.is("slot", "all")) {
    fields.take("slot");
  } else {
    slot = fields.slot();
  }
  return {slot, fields.choice("fault", kFrameFaults), fields.count()};
}

command::ChangeParameters read_parameters(Fields& fields) {
  command::ChangeParameters wish{fields.slot(), {}};
  bool any = false;
  for (std::size_t knob = 0; knob < kAxisKnobCount; ++knob) {
    wish.value[knob] = fields.knob(kAxisKnobs[knob]);
    any = any || wish.value[knob];
  }
  if (!any) {
    fields.fail(std::string(kAxisKnobs[0].name), "expected this or another parameter of the README");
  }
  return wish;
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
    Form{"parameters", [](Fields& f) -> Wish { return read_parameters(f); }},
    Form{"parameters_restore", [](Fields& f) -> Wish { return command::RestoreParameters{f.slot()}; }},
    Form{
        "force",
        [](Fields& f) -> Wish { return command::PressSensor{f.slot(), f.analog_input(), f.force_counts()}; }},
    Form{"hand",
         [](Fields& f) -> Wish { return command::PressHand{f.number("newtons", command::kMostHandForce)}; }},
    Form{"target", [](Fields& f) -> Wish { return command::ShiftTarget{f.shift()}; }},
    Form{"frame", [](Fields& f) -> Wish { return read_frame_fault(f); }},
    Form{"card_reset", [](Fields& f) -> Wish { return command::ResetCard{f.slot()}; }},
    Form{"card_power", [](Fields& f) -> Wish { return command::PowerCard{f.slot(), f.flag("on")}; }},
    Form{"transaction", [](Fields& f) -> Wish { return command::FailTransactions{f.count()}; }},
    Form{"clear", [](Fields&) -> Wish { return command::Clear{}; }},
    Form{"image", [](Fields&) -> Wish { return ImageQuery{}; }},
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

}  // namespace interlock::plant::sim
