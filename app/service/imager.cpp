#include "service/imager.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace interlock {
namespace {

using nlohmann::json;

json word_json(const igtl::ImagerStatus& status) {
  return {{"code", status.code ? json(static_cast<int>(*status.code)) : json()},
          {"name", status.name},
          {"text", status.text}};
}

json word_json(const igtl::TipPose& tip) { return {{"scanner_from_tip", tip.scanner_from_tip}}; }

template <typename Heard>
json heard_json(const std::optional<Heard>& heard, SteadyTime now) {
  if (!heard) {
    return nullptr;
  }
  json body = word_json(heard->word);
  body["client"] = heard->client;
  body["received"] = iso_8601(heard->time);
  body["age_s"] = std::chrono::duration<double>(now - heard->since).count();
  return body;
}

}  // namespace

void Imager::hear(const igtl::ImagerWord& word, std::string client, UtcTime time, SteadyTime now) {
  if (const auto* tip = std::get_if<igtl::TipPose>(&word)) {
    tip_ = {*tip, std::move(client), time, now};
    return;
  }
  igtl::ImagerStatus status = std::get<igtl::ImagerStatus>(word);
  status.text.resize(std::min(status.text.size(), most_text_bytes));
  status_ = {std::move(status), std::move(client), time, now};
}

json Imager::to_json(SteadyTime now) const {
  return {{"status", heard_json(status_, now)}, {"tip", heard_json(tip_, now)}};
}

}  // namespace interlock
