------------------------------ MODULE KernelLive ------------------------------
(* What the kernel must let happen. The world does as it likes, as in KernelOne with
   a lawful plant, until it begins to cooperate, in whatever state the kernel then
   is; from there on it cooperates for good. Fairness is asked of time alone: it
   goes on. *)
EXTENDS KernelOne

VARIABLES
  aim,   \* "NONE", "MOVE" (holds the pedal, renews the lease), "RECOVER"
  clock  \* whether the number of ticks since then is odd

live == <<vars, aim, clock>>

LiveInit == Init /\ aim = "NONE" /\ clock = FALSE

Moving == /\ system.mode = "MOTION" /\ system.app_age_ticks = 0
          /\ axis.state = "MOVING" /\ axis.drive > 0

Wander == aim = "NONE" /\ Next /\ UNCHANGED <<aim, clock>>
Decide == /\ aim = "NONE"
          /\ aim' \in {"RECOVER"} \union (IF Moving THEN {"MOVE"} ELSE {})
          /\ UNCHANGED <<vars, clock>>

TimeGoesOn == aim # "NONE" /\ clock' = ~clock

(* L1: an accepted setpoint, the pedal held, the lease renewed in every tick. The
   plant goes the way it is driven, or sticks. *)
Renewal == MoveTo(axis.setpoint_counts, axis.drive, c.lease_max_ticks)

HoldOn ==
  /\ aim = "MOVE" /\ TimeGoesOn
  /\ Met("HoldOn")
  /\ \E m \in Moves :
       Step(Input("CLOSED", "CLOSED", Reading(m, "GOOD"), Append(Alive, Renewal)))
  /\ UNCHANGED aim

Underway == aim = "MOVE" /\ Moving
Reached  == Magnitude(axis.setpoint_counts - axis.position_counts) <= k.deadband_counts
AtSwitch == /\ plant.at <= body.switch_at
            /\ TowardsSetpoint(k, axis) = TowardsSwitch(k)

L1_progress == Underway ~> (Reached \/ axis.state = "FAULTED" \/ AtSwitch)

(* L2: release, acknowledge what is to be acknowledged, enable, press. *)
Remedy ==
  IF system.mode = "LOCKED" THEN Wish("RESET")
  ELSE IF axis.state = "FAULTED" THEN Wish("CLEAR_FAULT")
  ELSE Wish("ENABLE")

Pedal == IF axis.state = "FAULTED" THEN "OPEN" ELSE Held

Recover ==
  /\ aim = "RECOVER" /\ TimeGoesOn
  /\ Met("Recover")
  /\ Step(Input(Pedal, "CLOSED", Reading(0, "GOOD"), Append(Alive, Remedy)))
  /\ UNCHANGED aim

Recovered == system.mode = "MOTION" /\ IsEnabled(axis)

L2_recoverable == (aim = "RECOVER") ~> Recovered

LiveNext == Wander \/ Decide \/ HoldOn \/ Recover
LiveSpec == LiveInit /\ [][LiveNext]_live /\ WF_clock(TimeGoesOn)

-------------------------------------------------------------------------------
(* What the properties are about does happen: each says so. *)
AboutLive ==
  [][ /\ Underway => Met("L1_progress")
      /\ aim = "RECOVER" /\ system.mode = "LOCKED" /\ axis.state = "FAULTED"
         => Met("L2_recoverable") ]_live
===============================================================================
