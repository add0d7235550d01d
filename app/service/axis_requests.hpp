/**
 * @file
 * The same kernel request for several axes, one after the other.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "service/context.hpp"

namespace interlock {

struct AxisRequest {
  const Axis* axis = nullptr;
  std::uint32_t kind = 0;         /**< ilk_request_kind_t */
  std::int32_t target_counts = 0; /**< position of a RESTORE */
  std::string not_sent_because{}; /**< not empty: it only gets its row, with these words */
};

/**
 * Sends the requests in their order, each when the one before has its verdict; gives `AxisVerdicts` of
 * spec/openapi.yaml. A refusal does not hold up the others. When the kernel does not answer, or the caller
 * lost control meanwhile, the rest is not sent.
 */
boost::asio::awaitable<nlohmann::json> ask_each(const Context& context, const Caller& caller,
                                                std::vector<AxisRequest> requests);

}  // namespace interlock
