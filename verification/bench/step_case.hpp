/// One step of the kernel with all that it reads, to be played again.
#ifndef INTERLOCK_BENCH_STEP_CASE_HPP
#define INTERLOCK_BENCH_STEP_CASE_HPP

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "interlock/types.h"

namespace interlock::bench {

struct StepCase {
  ilk_config_t config{};
  ilk_state_t state{}; /**< before the step */
  ilk_inputs_t inputs{};
  std::vector<ilk_request_t> requests;
};

/// The words of each part, as numbers.
nlohmann::json json_of(const StepCase& step);

/// The case in a file of that form; otherwise what is wrong with it, with its path.
tl::expected<StepCase, std::string> read_step_case(const std::filesystem::path& path);

}  // namespace interlock::bench

#endif
