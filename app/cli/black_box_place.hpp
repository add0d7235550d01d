/**
 * @file
 * Where a robot's black box and its recordings are.
 */
#pragma once

#include <filesystem>

namespace interlock::cli {

/**
 * The file of the kernel's black box, in shared memory: one for each state directory, so that what a killed
 * run left is found by the next.
 */
std::filesystem::path black_box_file(const std::filesystem::path& state);

/** The folder of the recordings. */
std::filesystem::path recordings_folder(const std::filesystem::path& state);

}  // namespace interlock::cli
