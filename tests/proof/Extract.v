(* The functions by which judge.ml judges. Numbers become machine integers, and division theirs. *)
Require Import Arith State Split Merge Insert Build Check.
Require Extraction ExtrOcamlBasic ExtrOcamlNatInt.
Extract Inlined Constant Nat.div => "(/)".
Extract Inlined Constant Nat.modulo => "(mod)".
Extract Inlined Constant Nat.min => "Stdlib.min".
Extract Inlined Constant Nat.max => "Stdlib.max".
Extract Inlined Constant Nat.ltb => "(<)".
Extraction "model.ml" check corners_of split_vertex merge insert_in_face insert_on_edge build next prev.
