------------------------ MODULE CheckConfigurationRows ------------------------
(* Phase 1: whether the configuration is trusted, and the alarm. The records hold
   what it may read and nothing else: TLC fails at any other field. *)
EXTENDS Kernel

ASSUME
  \A pass \in {"NONE", "AGREES", "DIFFERS", "INVALID"}, sound \in BOOLEAN :
    LET in == [config_pass |-> pass]
        s == CheckConfiguration([config_sound |-> sound], in)
        alarms == Alarms(<<"unread">>, <<>>, <<>>, <<>>, in)
    IN PrintT(<< pass, sound, s.config_sound, alarms.configuration_damaged >>)
==============================================================================
