#include "proposals/checks.hpp"

#include <cmath>

#include "robot/catalog.hpp"
#include "robot/compile.hpp"

namespace interlock {
namespace {

tl::unexpected<Refusal> refused(std::uint32_t verdict, const std::string& where,
                                const std::string& expected) {
  return tl::make_unexpected(verdict_refusal(verdict, where, expected));
}

std::string current(catalog::Family family, std::uint32_t number, const char* what) {
  return std::string(what) + " is " + catalog::name(family, number);
}

tl::expected<void, Refusal> check_mode(const ControlView& view) {
  const std::uint32_t mode = view.snapshot.state.system.mode;
  if (mode != ILK_MODE_READY && mode != ILK_MODE_MOTION) {
    return refused(ILK_VERDICT_MODE, current(catalog::Family::mode, mode, "mode"), "READY or MOTION");
  }
  return {};
}

}  // namespace

std::string counts_and_unit(const Axis& axis, std::int32_t counts) {
  const double rounded = std::round(axis.to_unit(counts) * 1000.0) / 1000.0;
  std::string number = std::to_string(rounded);
  number.erase(number.find('.') + 4);
  return std::to_string(counts) + " counts (" + number + " " + std::string(unit_name(axis.unit)) + ")";
}

Refusal verdict_refusal(std::uint32_t verdict, const std::string& where, const std::string& expected) {
  const catalog::Entry& entry = catalog::entry(catalog::Family::verdict, verdict);
  std::string detail(entry.meaning);
  if (!where.empty()) {
    detail = where + ": " + detail;
  }
  return Refusal{catalog::name(catalog::Family::verdict, verdict), detail, expected,
                 std::string(entry.next_step)};
}

tl::expected<void, Refusal> check_configuration(const ilk_config_t& config, const ControlView& view) {
  if (view.snapshot.config_crc != config.crc) {
    return tl::make_unexpected(
        Refusal{"CONFIG_MISMATCH", "The kernel runs another configuration than this app's robot file.",
                "configuration " + config_hash(config), "Start kernel and app with the same robot."});
  }
  return {};
}

void check_system(const ilk_config_t& config, const ControlView& view, CheckList& checks) {
  checks.make(CheckName::configuration, [&] { return check_configuration(config, view); });
  checks.make(CheckName::mode, [&] { return check_mode(view); });
}

tl::expected<void, Refusal> check_axis(const Axis& axis, const ControlView& view) {
  const ilk_axis_t& state = view.snapshot.state.axis[axis.slot];
  switch (state.state) {
    case ILK_AXIS_ENABLED:
    case ILK_AXIS_MOVING:
    case ILK_AXIS_HOMING:
      return {};
    case ILK_AXIS_FAULTED:
      return refused(ILK_VERDICT_FAULTED, current(catalog::Family::fault, state.fault, axis.name.c_str()),
                     "an axis without a fault");
    default:
      return refused(ILK_VERDICT_DISABLED, axis.name, "an enabled axis");
  }
}

tl::expected<void, Refusal> check_free_axis(const Axis& axis, const ControlView& view) {
  return check_axis(axis, view).and_then([&]() -> tl::expected<void, Refusal> {
    if (view.snapshot.state.axis[axis.slot].state == ILK_AXIS_HOMING) {
      return refused(ILK_VERDICT_BUSY, axis.name, "an axis that is not homing");
    }
    return {};
  });
}

}  // namespace interlock
