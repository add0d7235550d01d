/**
 * @file
 * The runs that are kept, for people and programs: lists, one with its samples, its note, and how many stay.
 *
 * Each answers 503 STORE while the store fails.
 */
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "service/cases.hpp"
#include "store/runs.hpp"

namespace interlock {

/** Schema `RunList`: the newest that the filter lets through. */
CaseAnswer list_runs(const Context& context, RunFilter filter);

/** Schema `Run`; 404 NOT_FOUND. */
CaseAnswer show_run(const Context& context, std::int64_t number);

/** Schema `RunSamples`; 404 NOT_FOUND. */
CaseAnswer samples_of_run(const Context& context, std::int64_t number);

/** The samples of that run, both as in the schemas, in the units of its axes: time in seconds since the
 * begin, and of each axis the planned (empty where no time was planned), commanded and actual position. Comma
 * between the fields, a header, "." in the numbers. */
std::string samples_csv(const nlohmann::json& run, const nlohmann::json& samples);

/** Puts a note in the place of the one before, which may be empty; schema `Run`. Audited without its text.
 * 404 NOT_FOUND; 401 LOGIN. */
CaseAnswer annotate_run(const Context& context, const Caller& caller, std::int64_t number, std::string note);

/** From now on so many stay; schema `RunRetention`. Audited. 401 LOGIN. */
CaseAnswer set_run_retention(const Context& context, const Caller& caller, RunRetention retention);

}  // namespace interlock
