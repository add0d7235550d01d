#include <algorithm>

#include "robot/readers.hpp"

namespace interlock {
namespace {

constexpr std::array<std::string_view, 3> kinds{"home", "nudge", "move"};

bool has_switch(const Axis& axis) { return axis.limit != ILK_LIMIT_NONE; }

std::string in_quotes(const std::string& name) { return '"' + name + '"'; }

std::string axis_names(const Robot& robot) {
  std::string names;
  for (const Axis& axis : robot.axes) {
    names += (names.empty() ? "" : ", ") + axis.name;
  }
  return names;
}

/** Reads counts by axis; `refuse` judges each of them. */
template <typename Refuse>
std::vector<AxisCounts> read_counts(TableReader& table, std::string_view kind, const Robot& robot,
                                    Refuse refuse) {
  TableReader entries = table.table(kind);
  std::vector<AxisCounts> travel;
  for (const std::string& name : entries.keys()) {
    const auto counts = entries.integer<std::int32_t>(name);
    if (const Axis* const axis = robot.find(name)) {
      refuse(entries, *axis, counts);
      travel.push_back({axis->slot, counts});
    } else {
      entries.refuse(name, "no axis is called " + in_quotes(name), "one of " + axis_names(robot));
    }
  }
  if (travel.empty()) {
    table.refuse(kind, "it names no axis", "counts for at least one axis");
  }
  return travel;
}

/** Reads the steps in their order and remembers which axes have homed by then. */
class StepReader {
 public:
  explicit StepReader(Robot& robot) : robot_(robot) {}

  HomeStep read(TableReader table) {
    HomeStep step;
    step.name = table.identifier("name");
    table.rename("home_step." + step.name);
    if (std::ranges::find(robot_.home_steps, step.name, &HomeStep::name) != robot_.home_steps.end()) {
      table.refuse("name", "another step is called " + in_quotes(step.name) + " already",
                   "a name of its own");
    }
    step.title = table.text("title");
    read_travel(table, step);
    table.refuse_unknown_keys();
    return step;
  }

  [[nodiscard]] bool homes(const Axis& axis) const { return homed_.contains(axis.slot); }

 private:
  void read_travel(TableReader& table, HomeStep& step) {
    if (std::ranges::count_if(kinds, [&table](std::string_view kind) { return table.has(kind); }) != 1) {
      table.refuse_table("it has none or several of home, nudge and move", "exactly one of them");
    }
    if (table.has("home")) {
      step.home = read_home(table);
    }
    if (table.has("nudge")) {
      step.nudge = read_nudge(table);
    }
    if (table.has("move")) {
      step.move = read_move(table);
    }
  }

  std::vector<std::uint32_t> read_home(TableReader& table) {
    const std::string expected = "names of axes with a switch that no other step homes, at least one";
    std::vector<std::uint32_t> slots;
    for (const std::string& name : table.texts("home", expected)) {
      const Axis* const axis = robot_.find(name);
      if (!axis) {
        table.refuse("home", "no axis is called " + in_quotes(name), expected);
      } else if (!has_switch(*axis)) {
        table.refuse("home", in_quotes(name) + " has no switch to home at", expected);
      } else if (!homed_.insert(axis->slot).second) {
        table.refuse("home", in_quotes(name) + " homes twice", expected);
      } else {
        slots.push_back(axis->slot);
      }
    }
    if (slots.empty()) {
      table.refuse("home", "it names no axis", expected);
    }
    return slots;
  }

  std::vector<AxisCounts> read_nudge(TableReader& table) const {
    return read_counts(
        table, "nudge", robot_, [this](TableReader& entries, const Axis& axis, std::int32_t counts) {
          if (!has_switch(axis) || homes(axis)) {
            entries.refuse(axis.name,
                           has_switch(axis) ? "the axis is homed by then" : "the axis has no switch",
                           "an axis that a later step homes");
          } else if (counts == 0) {
            entries.refuse(axis.name, "0 counts are no travel", "a signed distance in counts");
          }
        });
  }

  std::vector<AxisCounts> read_move(TableReader& table) const {
    return read_counts(table, "move", robot_, [this](TableReader& entries, const Axis& axis, std::int32_t) {
      if (!homes(axis)) {  // An axis without a switch is homed by hand, on which no step can rely.
        entries.refuse(axis.name, "the axis is not homed by then", "an axis that an earlier step homes");
      }
    });
  }

  Robot& robot_;
  std::set<std::uint32_t> homed_;
};

}  // namespace

void read_home_steps(TableReader& table, Robot& robot) {
  const std::string expected = "[[home_step]] tables, in the order in which they run";
  StepReader reader(robot);
  if (table.has("home_step")) {
    for (TableReader& entry : table.tables("home_step", expected)) {
      robot.home_steps.push_back(reader.read(std::move(entry)));
    }
  }
  for (const Axis& axis : robot.axes) {
    if (has_switch(axis) && !reader.homes(axis)) {
      table.refuse("home_step", "no step homes " + in_quotes(axis.name),
                   "every axis with a switch in exactly one home list");
    }
  }
}

void read_draping(TableReader& table, Robot& robot) {
  if (table.has("draping")) {
    robot.draping =
        read_counts(table, "draping", robot, [](const TableReader&, const Axis&, std::int32_t) {});
  }
}

}  // namespace interlock
