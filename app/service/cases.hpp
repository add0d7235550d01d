/**
 * @file
 * Cases: what registration, entry, target, probe and motions belong to. At most one is not closed, and
 * nothing of it is in force before somebody has opened or resumed it since the app was started.
 *
 * In the store, a case has these values besides its state: label, robot, configuration, opened, changed,
 * notes and last_set as in schema `Case` of spec/openapi.yaml, targeting, reason (why it is suspended), and
 * the numbers of the audit's first_record and last_record.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "service/context.hpp"
#include "service/reply.hpp"

namespace interlock {

/** What the case was, or the problem. */
using CaseAnswer = boost::asio::awaitable<tl::expected<nlohmann::json, Problem>>;

/** Names of the black box' recordings in the folder that were finished between those times, as `iso_8601`
 * writes them, or just afterwards; without an end: until now. */
nlohmann::json recordings_between(const std::filesystem::path& folder, const std::string& from,
                                  const std::optional<std::string>& until);

/** Schema `Case`, of the newest 200. */
CaseAnswer list_cases(const Context& context);

/** Schema `CaseExport`; 404 NOT_FOUND. */
CaseAnswer export_case(const Context& context, std::int64_t number);

/** From now on that case is in force, by whom; 0: none. What belonged to another one ends. */
void put_in_force(const Context& context, std::int64_t number, const std::string& by);

// What people do with a case. Each answers schema `Case`, as it is then, and is audited without what people
// wrote: label and notes can be deleted. 404 NOT_FOUND; 409 CASE when its state does not allow it; 401 LOGIN
// and 409 CONTROL when the caller has lost session or control meanwhile; 503 STORE.

/** Opens a case; every registration of one before it counts as expired, to programs too. */
CaseAnswer open_case(const Context& context, Caller caller, std::string label);

/** Resumes the suspended case; 409 OTHER_ROBOT unless it was opened with this one. */
CaseAnswer resume_case(const Context& context, Caller caller, std::int64_t number);

/** Takes the open case out of force at once, with every motion that was proposed in it. */
CaseAnswer suspend_case(const Context& context, const Caller& caller, std::int64_t number);

/** As `suspend_case`, for ever; of a suspended one too. */
CaseAnswer close_case(const Context& context, const Caller& caller, std::int64_t number);

/** Adds a note to a case that is not closed. */
CaseAnswer add_case_note(const Context& context, const Caller& caller, std::int64_t number, std::string text);

/** Deletes a closed case. */
CaseAnswer delete_case(const Context& context, const Caller& caller, std::int64_t number);

}  // namespace interlock
