--------------------------- MODULE ApplySystemRows ---------------------------
(* Phase 6: the effect of requests that name no axis. The records hold what it
   may read and nothing else: TLC fails at any other field. *)
EXTENDS System, TLC

ASSUME
  \A kind \in SystemKinds, mode \in Modes, same \in BOOLEAN, armed \in BOOLEAN, pressed \in
     0..2, released \in 0..2, age \in 0..2 :
    LET before == [ mode |-> mode, holder |-> IF same THEN 7 ELSE 8, pedal_armed |-> armed,
                    pedal_pressed_ticks |-> pressed, pedal_released_ticks |-> released, app_age_ticks |-> age,
                    cause |-> "BOOT", causes_seen |-> {"BOOT"} ]
        s == ApplySystem(before, [kind |-> kind, holder |-> 7])
        expected == IF kind = "RESET" THEN "NONE" ELSE "BOOT"
    IN PrintT(<< kind, mode, same, armed, pressed, released, age, s.mode, s.holder = 7, s.pedal_armed,
                 s.pedal_pressed_ticks, s.pedal_released_ticks, s.app_age_ticks >>)
==============================================================================
