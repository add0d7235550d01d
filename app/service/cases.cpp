#include "service/cases.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <utility>

#include "service/targeting_store.hpp"
#include "store/sessions.hpp"

namespace interlock {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t most_cases = 200;
constexpr std::size_t most_notes = 200;
constexpr std::size_t most_records = 5000;

/** What cases are looked at with. */
struct Look {
  const Robot* robot;
  std::string configuration;
  InForce in_force;

  explicit Look(const Context& context)
      : robot(&context.robot), configuration(context.robot.revision), in_force(context.in_force) {}

  [[nodiscard]] bool is_open(const KeptCase& kept) const {
    return kept.state == CaseState::open && kept.number == in_force.open_case;
  }

  /** The state by name; one that is kept as open and not in force is suspended. */
  [[nodiscard]] std::string_view state_of(const KeptCase& kept) const {
    return case_state_name(kept.state == CaseState::open && !is_open(kept) ? CaseState::suspended
                                                                           : kept.state);
  }
};

/** Schema `Case`. */
Stored<json> case_json(const KeptCase& kept, const Look& look) {
  return targeting_of(kept).map([&](const Targeting& stored) {
    const Targeting targeting = judged(stored, look.in_force);
    const std::string robot = kept.value.value("robot", "");
    const std::string configuration = kept.value.value("configuration", "");
    return json{{"number", kept.number},
                {"label", kept.value.value("label", "")},
                {"state", look.state_of(kept)},
                {"problem", targeting.case_problem.empty() ? json() : json(targeting.case_problem)},
                {"robot", robot},
                {"configuration", configuration},
                {"configuration_changed", robot == look.robot->name && configuration != look.configuration},
                {"opened", kept.value.value("opened", json::object())},
                {"changed", kept.value.value("changed", json::object())},
                {"notes", kept.value.value("notes", json::array())},
                {"targeting", to_json(targeting)},
                {"last_set", kept.value.value("last_set", json::object())}};
  });
}

/** As in a list, which may be long: without what only the case in hand has to show. */
Stored<json> listed(const KeptCase& kept, const Look& look) {
  return case_json(kept, look).map([&](json shown) {
    if (kept.state == CaseState::closed) {
      shown["targeting"] = nullptr;
      shown["notes"] = json::array();
      shown["last_set"] = json::object();
    }
    return shown;
  });
}

/** Of the time until it was closed. */
json recordings_of(const KeptCase& kept, const fs::path& folder) {
  const auto time_of = [&](const char* step) {
    return kept.value.value(step, json::object()).value("time", "");
  };
  return recordings_between(
      folder, time_of("opened"),
      kept.state == CaseState::closed ? std::optional<std::string>(time_of("changed")) : std::nullopt);
}

Problem no_such_case(std::int64_t number) {
  return not_found("case " + std::to_string(number), "a number that /api/cases lists");
}

Problem wrong_state(const KeptCase& kept, const Look& look, const char* expected, const char* next_step) {
  return {.status = Status::conflict,
          .code = "CASE",
          .detail = "Case " + std::to_string(kept.number) + " is " + std::string(look.state_of(kept)) + ".",
          .expected = expected,
          .next_step = next_step};
}

/** A step that somebody takes with a case, on the store's thread. */
struct Step {
  Look look;
  AuditEntry entry; /**< of its record */
  std::int64_t number = 0;
  std::string text = {}; /**< a label or a note */
  Role role = Role::engineer;
  std::optional<MotionControl::Hold> hold = std::nullopt; /**< that has to last */

  Step(const Context& context, const Caller& caller, const char* action, std::int64_t of)
      : look(context), entry(context.entry(caller, AuditKind::case_step, {{"action", action}})), number(of) {}

  [[nodiscard]] json taken() const { return {{"time", iso_8601(entry.time)}, {"user", entry.actor}}; }
};

/** The case as it is then, or why the step was not taken. */
using Outcome = tl::expected<json, Problem>;

Stored<Outcome> as_outcome(Stored<json> shown) {
  return std::move(shown).map([](json body) { return Outcome(std::move(body)); });
}

/** Records the step. */
std::int64_t record(Transaction& transaction, const Step& step) {
  AuditEntry entry = step.entry;
  entry.detail["case"] = step.number;
  return Audit(transaction).append(entry).number;
}

/** Whether whoever takes the step still may; a problem that is no error of the store is in its place. */
Stored<tl::expected<void, Problem>> may_take(Transaction& transaction, const Step& step) {
  return Sessions(transaction)
      .need(step.entry.session.value_or(0), step.role, step.entry.time)
      .map([&](const Session&) -> tl::expected<void, Problem> {
        if (step.hold && !step.hold->lasts()) {
          return fail(control_lost());
        }
        return {};
      });
}

/** Takes a step in one transaction, if whoever takes it still may. */
struct Taking {
  Step step;
  Stored<Outcome> (*take)(Transaction&, Step&);

  Stored<Outcome> operator()(Store& store) {
    return store.transact([this](Transaction& transaction) -> Stored<Outcome> {
      const auto may = may_take(transaction, step);
      if (!may || !*may) {
        return may ? Stored<Outcome>(fail(may->error())) : tl::unexpected(may.error());
      }
      return take(transaction, step);
    });
  }
};

/** Changes a case that exists and is not closed; after a problem, nothing has changed. */
template <tl::expected<void, Problem> (*change)(Step&, KeptCase&)>
Stored<Outcome> changed(Transaction& transaction, Step& step) {
  Cases cases(transaction);
  auto kept = cases.find(step.number);
  const auto done = kept ? change(step, *kept) : fail(no_such_case(step.number));
  if (!done) {
    return Outcome(fail(done.error()));
  }
  const std::int64_t written = record(transaction, step);
  if (kept->state == CaseState::closed) {
    kept->value["last_record"] = written;
  }
  cases.change(*kept);
  return as_outcome(case_json(*kept, step.look));
}

Stored<Outcome> open(Transaction& transaction, Step& step) {
  Cases cases(transaction);
  if (const auto other = cases.in_hand()) {
    return Outcome(fail(
        wrong_state(*other, step.look, "no other case that is not closed", "Close it first, or resume it.")));
  }
  KeptCase opened{.value = {{"label", step.text},
                            {"robot", step.look.robot->name},
                            {"configuration", step.look.configuration},
                            {"opened", step.taken()},
                            {"changed", step.taken()},
                            {"notes", json::array()},
                            {"targeting", to_stored(first_targeting(*step.look.robot))},
                            {"last_set", json::object()}}};
  opened.number = cases.add(opened.value);
  step.number = opened.number;
  step.look.in_force.open_case = opened.number;
  opened.value["first_record"] = record(transaction, step);
  cases.change(opened);
  return as_outcome(case_json(opened, step.look));
}

tl::expected<void, Problem> resume(Step& step, KeptCase& kept) {
  if (step.look.state_of(kept) != case_state_name(CaseState::suspended)) {
    return fail(wrong_state(kept, step.look, "a suspended case", "Open another one, if that is wanted."));
  }
  if (const std::string robot = kept.value.value("robot", ""); robot != step.look.robot->name) {
    return fail(Problem{.status = Status::conflict,
                        .code = "OTHER_ROBOT",
                        .detail = "Case " + std::to_string(kept.number) + " was opened with the robot " +
                                  robot + ", and this is " + step.look.robot->name + ".",
                        .expected = "a case of this robot",
                        .next_step = "Close it, and open another one."});
  }
  kept.state = CaseState::open;
  kept.value["configuration"] = step.look.configuration;
  kept.value["changed"] = step.taken();
  step.look.in_force.open_case = kept.number;
  return {};
}

tl::expected<void, Problem> suspend(Step& step, KeptCase& kept) {
  if (!step.look.is_open(kept)) {
    return fail(wrong_state(kept, step.look, "an open case", "Nothing of it is in force."));
  }
  step.look.in_force.open_case = 0;
  kept.state = CaseState::suspended;
  kept.value["reason"] = step.entry.actor + " suspended it.";
  kept.value["changed"] = step.taken();
  return {};
}

tl::expected<void, Problem> close(Step& step, KeptCase& kept) {
  if (kept.state == CaseState::closed) {
    return fail(wrong_state(kept, step.look, "a case that is not closed", "Nothing of it is in force."));
  }
  kept.state = CaseState::closed;
  kept.value["changed"] = step.taken();
  return {};
}

tl::expected<void, Problem> add_note(Step& step, KeptCase& kept) {
  if (kept.state == CaseState::closed) {
    return fail(wrong_state(kept, step.look, "a case that is not closed", "Note it elsewhere."));
  }
  json& notes = kept.value["notes"];
  if (notes.size() >= most_notes) {
    return fail(Problem{.status = Status::conflict,
                        .code = "CASE",
                        .detail = "Case " + std::to_string(kept.number) + " has 200 notes already.",
                        .expected = "at most 200 notes",
                        .next_step = "Note it elsewhere."});
  }
  json note = step.taken();
  note["text"] = step.text;
  notes.push_back(std::move(note));
  return {};
}

Stored<Outcome> remove(Transaction& transaction, Step& step) {
  Cases cases(transaction);
  const auto kept = cases.find(step.number);
  if (!kept) {
    return Outcome(fail(no_such_case(step.number)));
  }
  if (kept->state != CaseState::closed) {
    return Outcome(fail(wrong_state(*kept, step.look, "a closed case", "Close it first.")));
  }
  record(transaction, step);
  cases.remove(step.number);
  return as_outcome(case_json(*kept, step.look));
}

template <typename Work>
CaseAnswer answer(const Context& context, Work work) {
  auto done = co_await context.store.run(std::move(work));
  if (!done) {
    co_return fail(done.error());
  }
  co_return std::move(*done);
}

/** Ends its force at once, whatever becomes of it in the store; and once more, as somebody may have resumed
 * it before the store kept the end. */
CaseAnswer take_out_of_force(const Context& context, Taking ending) {
  const auto end = [&context, number = ending.step.number, by = ending.step.entry.actor] {
    if (context.in_force.open_case == number) {
      put_in_force(context, 0, by);
    }
  };
  end();
  auto ended = co_await answer(context, std::move(ending));
  end();
  co_return ended;
}

}  // namespace

json recordings_between(const fs::path& folder, const std::string& from,
                        const std::optional<std::string>& until) {
  // A recording goes on for two seconds after what it is about.
  constexpr std::chrono::seconds afterwards{5};
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator each(folder, error); !error && each != fs::directory_iterator();
       each.increment(error)) {
    std::error_code gone;
    const auto written = fs::last_write_time(each->path(), gone);
    const auto time =
        std::chrono::time_point_cast<UtcTime::duration>(std::chrono::file_clock::to_sys(written));
    const bool is_within = iso_8601(time) >= from && (!until || iso_8601(time - afterwards) <= *until);
    if (!gone && each->path().extension() == ".ilkr" && is_within) {
      names.push_back(each->path().filename());
    }
  }
  std::ranges::sort(names);
  return names;
}

void put_in_force(const Context& context, std::int64_t number, const std::string& by) {
  if (std::exchange(context.in_force.open_case, number) != 0) {
    context.trajectory = {};
  }
  context.registry.enter_case(number, by);
  context.alarms.note_registration("");  // that of another case
}

CaseAnswer list_cases(const Context& context) {
  auto list = [look = Look(context)](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<Outcome> {
      json all = json::array();
      for (const KeptCase& kept : Cases(transaction).list(most_cases)) {
        auto shown = listed(kept, look);
        if (!shown) {
          return tl::unexpected(shown.error());
        }
        all.push_back(std::move(*shown));
      }
      return Outcome(std::move(all));
    });
  };
  return answer(context, std::move(list));
}

CaseAnswer export_case(const Context& context, std::int64_t number) {
  auto find = [number, look = Look(context), folder = context.noted_heads.parent_path()](Store& store) {
    return store.read([&](Transaction& transaction) -> Stored<Outcome> {
      const Cases cases(transaction);
      const auto kept = cases.find(number);
      if (!kept) {
        return Outcome(fail(no_such_case(number)));
      }
      const std::int64_t first = kept->value.value("first_record", std::int64_t{0});
      const Audit audit(transaction);
      const auto records =
          audit.between(first, kept->value.value("last_record", std::numeric_limits<std::int64_t>::max()),
                        {AuditKind::case_step, AuditKind::control, AuditKind::proposal, AuditKind::request,
                         AuditKind::setting, AuditKind::stop, AuditKind::verdict},
                        most_records);
      auto shown = case_json(*kept, look);
      if (shown) {
        (*shown)["schema"] = "interlock.case/1";
        (*shown)["changes"] = cases.changes(number, most_records);
        (*shown)["recordings"] = recordings_of(*kept, folder);
        (*shown)["records"] = json::array();
        for (const AuditRecord& each : records) {
          (*shown)["records"].push_back(to_json(each));
        }
        (*shown)["records_complete"] =
            first > audit.anchor().number && !records.empty() && records.front().number == first;
      }
      return as_outcome(std::move(shown));
    });
  };
  return answer(context, std::move(find));
}

CaseAnswer open_case(const Context& context, Caller caller, std::string label) {
  Step step(context, caller, "open", 0);
  step.text = std::move(label);
  step.hold = context.motion_control.hold();
  Taking opening{std::move(step), open};
  auto opened = co_await answer(context, std::move(opening));
  if (opened) {
    put_in_force(context, opened->at("number"), caller.user);
  }
  co_return opened;
}

CaseAnswer resume_case(const Context& context, Caller caller, std::int64_t number) {
  Step step(context, caller, "resume", number);
  step.hold = context.motion_control.hold();
  Taking taking{std::move(step), changed<resume>};
  auto resumed = co_await answer(context, std::move(taking));
  if (resumed) {
    put_in_force(context, number, caller.user);
    const auto targeting = co_await present_targeting(context);
    if (targeting && targeting->registration && !targeting->registration_problem.empty()) {
      const std::string& kept = targeting->registration_expired;
      context.alarms.note_registration(kept.empty() ? context.in_force.reason : kept);
    }
  }
  co_return resumed;
}

CaseAnswer suspend_case(const Context& context, const Caller& caller, std::int64_t number) {
  return take_out_of_force(context, {Step(context, caller, "suspend", number), changed<suspend>});
}

CaseAnswer close_case(const Context& context, const Caller& caller, std::int64_t number) {
  return take_out_of_force(context, {Step(context, caller, "close", number), changed<close>});
}

CaseAnswer add_case_note(const Context& context, const Caller& caller, std::int64_t number,
                         std::string text) {
  Step step(context, caller, "note", number);
  step.text = std::move(text);
  return answer(context, Taking{std::move(step), changed<add_note>});
}

CaseAnswer delete_case(const Context& context, const Caller& caller, std::int64_t number) {
  Step step(context, caller, "delete", number);
  step.role = Role::admin;
  return answer(context, Taking{std::move(step), remove});
}

}  // namespace interlock
