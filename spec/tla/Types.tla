-------------------------------- MODULE Types --------------------------------
(* The words of the kernel, named as in spec/catalog.toml and types.h, and the
   small arithmetic that all parts of the model share. How to read the model:
   docs/model.md. *)
EXTENDS Integers, Sequences, FiniteSets

Modes       == {"INIT", "LOCKED", "READY", "MOTION"}
Causes      == {"NONE", "BOOT", "ESTOP", "BUS", "PEDAL", "INTEGRITY", "OVERRUN"}
PedalStates == {"RELEASED", "PRESSED", "DISAGREE"}
Contacts    == {"CLOSED", "OPEN", "INVALID"}
AxisStates  == {"DISABLED", "ENABLED", "MOVING", "HOMING", "FAULTED"}
Faults      == {"NONE", "STALL", "REVERSE", "DRIFT", "JUMP", "CARD_LOST",
                "HOMING_TRAVEL", "HOMING_TIMEOUT"}
Directions  == {"NONE", "INCREASING", "DECREASING"}
Phases      == {"NONE", "BACK_OFF", "SEEK", "REST"}
Sides       == {"NONE", "LOWER", "UPPER"}
Frames      == {"GOOD", "MISSING", "CORRUPT", "LATE", "REPEATED"}

SystemKinds == {"HEARTBEAT", "STOP", "RESET"}
AxisKinds   == {"DISABLE", "ENABLE", "CLEAR_FAULT", "MOVE", "HOME", "SET_HOME",
                "RESTORE"}
Kinds       == SystemKinds \union AxisKinds

(* What a request meets before its row of the table: its CRC is wrong, its
   number is not newer, or neither. CRC and numbers themselves are not
   modelled; the environment says which it is. *)
Doors       == {"INTACT", "CHECKSUM", "SEQUENCE"}

NoDrive     == [direction |-> "NONE", drive |-> 0]

(* A count that stops at its ceiling. A ceiling is the first value from which on
   no larger one changes what the kernel does. *)
CountUp(value, ceiling) == IF value < ceiling THEN value + 1 ELSE ceiling
CountDown(value)        == IF value > 0 THEN value - 1 ELSE 0

Magnitude(travel) == IF travel < 0 THEN -travel ELSE travel

(* Travel counted positive along a direction, zero along none. *)
Along(direction, travel) ==
  CASE direction = "INCREASING" -> travel
    [] direction = "DECREASING" -> -travel
    [] OTHER                    -> 0
===============================================================================
