/**
 * @file
 * The classes of SQLiteCpp that headers name, so that whoever includes those needs none of its own headers.
 */
#pragma once

namespace SQLite {  // NOLINT(readability-identifier-naming): the library's name
class Database;
class Exception;
class Statement;
}  // namespace SQLite
