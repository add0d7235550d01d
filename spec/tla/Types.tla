-------------------------------- MODULE Types --------------------------------
(* The words of the kernel, named as in spec/catalog.toml and types.h, and the
   small arithmetic that all parts of the model share. How to read the model:
   docs/model.md. *)
EXTENDS Integers, Sequences, FiniteSets

Modes       == {"INIT", "LOCKED", "READY", "MOTION"}
Causes      == {"NONE", "BOOT", "INTEGRITY", "ESTOP", "BUS", "PEDAL", "OVERRUN", "RUNAWAY"}
PedalStates == {"RELEASED", "PRESSED", "DISAGREE"}
Contacts    == {"CLOSED", "OPEN", "INVALID"}
AxisStates  == {"DISABLED", "ENABLED", "MOVING", "HOMING", "FAULTED"}
Faults      == {"NONE", "INTEGRITY", "CARD", "CARD_RESET", "JUMP", "REVERSE", "DRIFT", "STALL",
                "SWITCH", "HOMING_TRAVEL", "HOMING_TIMEOUT"}
Directions  == {"NONE", "INCREASING", "DECREASING"}
Phases      == {"NONE", "WAIT", "BACK_OFF", "APPROACH", "BACK_OFF_AGAIN", "APPROACH_SLOWLY", "REST"}
Sides       == {"NONE", "LOWER", "UPPER"}
Homes       == {"NO", "SWITCH", "HAND"}

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
CountBy(value, step, ceiling) == IF value + step < ceiling THEN value + step ELSE ceiling
CountUp(value, ceiling)       == CountBy(value, 1, ceiling)
CountDown(value)              == IF value > 0 THEN value - 1 ELSE 0

Magnitude(travel) == IF travel < 0 THEN -travel ELSE travel
Least(x, y)       == IF x < y THEN x ELSE y
Greatest(x, y)    == IF x < y THEN y ELSE x

(* Travel counted positive along a direction, zero along none. *)
Along(direction, travel) ==
  CASE direction = "INCREASING" -> travel
    [] direction = "DECREASING" -> -travel
    [] OTHER                    -> 0

(* A run of readings that lie within `width` of each other; it begins anew at the
   reading that lies too far from another. `ticks` is how long it lasts. *)
RunAt(raw) == [low |-> raw, high |-> raw, ticks |-> 0]

Prolonged(run, raw, width, ceiling) ==
  LET low == Least(run.low, raw)  high == Greatest(run.high, raw)
  IN  IF high - low > width THEN RunAt(raw)
      ELSE [low |-> low, high |-> high, ticks |-> CountUp(run.ticks, ceiling)]
===============================================================================
