------------------------------ MODULE KernelLive ------------------------------
(* What the kernel must let happen. The world does as it likes, as in KernelLimits,
   until it begins to cooperate, in whatever state the kernel then is; from there on it
   cooperates for good. Fairness is asked of time alone: it goes on. *)
EXTENDS KernelLimits

(* From the commanded drive it coasts no farther than twice the deadband. *)
LiveAxis ==
  [SoftAxis EXCEPT !.deadband_counts = 1, !.stall_ticks = 3, !.stall_effort_ticks = 0]

VARIABLES
  aim,   \* "NONE", "MOVE" (holds the pedal, renews the lease), "RECOVER"
  goal,  \* of "MOVE": its setpoint
  clock  \* whether the number of ticks since then is odd

live == <<vars, aim, goal, clock>>

LiveView == <<View, aim, goal, clock>>

LiveInit == Init /\ aim = "NONE" /\ goal = 0 /\ clock = FALSE

Wander == aim = "NONE" /\ Next /\ UNCHANGED <<aim, goal, clock>>

MayMove == system.mode = "MOTION" /\ system.app_age_ticks = 0 /\ IsEnabled(axis) /\ IsHomed(axis)

Decide ==
  /\ aim = "NONE"
  /\ \/ aim' = "RECOVER" /\ goal' = 0
     \/ MayMove /\ aim' = "MOVE" /\ goal' \in {1, 3}
  /\ UNCHANGED <<vars, clock>>

TimeGoesOn == aim # "NONE" /\ clock' = ~clock

(* L1: the pedal held, the setpoint renewed in every tick, no frame lost. The plant goes
   the way it is driven, coasts, or sticks, and its readings dither. *)
HoldOn ==
  /\ aim = "MOVE" /\ TimeGoesOn
  /\ Met("HoldOn")
  /\ \E m \in {m \in LawfulMoves : Inside(m)}, n \in {0, 1} :
       Step(Input("CLOSED", Reading(plant.at + m + n, FALSE), <<Beat, MoveTo(goal, 1, c.lease_max_ticks)>>), m,
            {<<>>})
  /\ UNCHANGED <<aim, goal>>

(* Accepted: the lease lives. A reading that dithers may leave the deadband by the noise. *)
Underway == aim = "MOVE" /\ axis.state = "MOVING"
Reached  == Magnitude(goal - axis.position_counts) <= k.deadband_counts + k.noise_counts

L1_progress == <>[](Underway => Reached)

(* L2: release, acknowledge what is to be acknowledged, enable, press. *)
Remedy ==
  IF system.mode = "LOCKED" THEN Ask("RESET")
  ELSE IF axis.state = "FAULTED" THEN Ask("CLEAR_FAULT")
  ELSE Ask("ENABLE")

Pedal == IF axis.state \in {"FAULTED", "DISABLED"} THEN "OPEN" ELSE Held

Recover ==
  /\ aim = "RECOVER" /\ TimeGoesOn
  /\ Met("Recover")
  /\ \E n \in {0, 1} :
       Step(Input(Pedal, Reading(plant.at + n, plant.at <= body.closes), <<Beat, Remedy>>), 0, {<<>>})
  /\ UNCHANGED <<aim, goal>>

Recovered == system.mode = "MOTION" /\ IsEnabled(axis)

L2_recoverable == (aim = "RECOVER") ~> Recovered

LiveNext == Wander \/ Decide \/ HoldOn \/ Recover
LiveSpec == LiveInit /\ [][LiveNext]_live /\ WF_clock(TimeGoesOn)

-------------------------------------------------------------------------------
(* What the properties are about does happen: each says so. *)
AboutLive ==
  [][ /\ Underway /\ Reached => Met("L1_progress")
      /\ aim = "RECOVER" /\ axis.state = "FAULTED" => Met("L2_recoverable") ]_live
===============================================================================
