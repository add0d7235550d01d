/**
 * @file
 * Proposals as the HTTP interface shows them.
 */
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "proposals/proposal.hpp"

namespace interlock {

/** Schema `Proposal` of spec/openapi.yaml. */
nlohmann::json to_json(const Proposal& proposal);

}  // namespace interlock
