------------------------ MODULE CheckConfigurationRows ------------------------
(* Phase 1: whether the configuration is trusted. The records hold what it may read
   and nothing else: TLC fails at any other field. *)
EXTENDS System, TLC

ASSUME
  \A pass \in {"NONE", "AGREES", "DIFFERS", "INVALID"}, sound \in BOOLEAN :
    LET s == CheckConfiguration([config_sound |-> sound], [config_pass |-> pass])
    IN PrintT(<< pass, sound, s.config_sound >>)
==============================================================================
