#include "case_file.hpp"

#include <istream>
#include <ostream>
#include <sstream>

#include "interlock/types.h"

namespace interlock::campaign {
namespace {

constexpr std::string_view kTitle = "interlock campaign case 2";

}  // namespace

void write_case(std::ostream& out, const Case& plan) {
  out << kTitle << "\nseed " << plan.seed << "\nnumber " << plan.number << "\nticks " << plan.ticks
      << "\n# tick kind slot ticks amount driven_ticks\n";
  for (const Fault& fault : plan.faults) {
    out << "fault " << fault.tick << ' ' << static_cast<unsigned>(fault.kind) << ' ' << fault.slot << ' '
        << fault.ticks << ' ' << fault.amount << ' ' << fault.driven_ticks << " # " << name_of(fault.kind)
        << '\n';
  }
}

tl::expected<Case, std::string> read_case(std::istream& in) {
  Case plan;
  std::string line;
  std::size_t number = 1;
  if (!std::getline(in, line) || line != kTitle) {
    return tl::unexpected("line 1: expected '" + std::string(kTitle) + "'");
  }
  while (std::getline(in, line)) {
    number++;
    std::istringstream words(line);
    std::string key;
    if (!(words >> key) || key.front() == '#') {
      continue;
    }
    bool understood = false;
    if (key == "seed") {
      understood = static_cast<bool>(words >> plan.seed);
    } else if (key == "number") {
      understood = static_cast<bool>(words >> plan.number);
    } else if (key == "ticks") {
      understood = static_cast<bool>(words >> plan.ticks);
    } else if (key == "fault") {
      Fault fault;
      unsigned kind = 0;
      understood =
          (words >> fault.tick >> kind >> fault.slot >> fault.ticks >> fault.amount >> fault.driven_ticks) &&
          kind < kFaultKinds && fault.slot < ILK_SLOTS &&
          (plan.faults.empty() || plan.faults.back().tick <= fault.tick);
      fault.kind = static_cast<FaultKind>(kind);
      plan.faults.push_back(fault);
    }
    if (!understood) {
      return tl::unexpected("line " + std::to_string(number) +
                            ": expected seed, number, ticks or fault with its numbers, faults by tick");
    }
  }
  return plan;
}

}  // namespace interlock::campaign
