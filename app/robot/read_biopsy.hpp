/**
 * @file
 * Reads the [biopsy] table of a robot file. Private to this folder.
 */
#pragma once

#include "robot/table_reader.hpp"

namespace interlock {

/** Reads what the mode "cooperative_biopsy" needs, when it is there; the sensors are known already. */
void read_biopsy(TableReader& table, Robot& robot);

}  // namespace interlock
