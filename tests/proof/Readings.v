(* Six readings of the paper that fail: the table at the end of src/mesh/invariants.md, computed. After them, three
   wrong ways to insert a vertex.

   Souza et al. 2014 §IV-B leaves open how the faces of a vertex are found through ghost pairs. Each reading is written
   down, and an example says what it gives on its shortest counter-example, beside what there is. *)
Require Import Arith List Lia Bool.
Require Import Walk State Split Merge Cone Insert Outline Check.
Import ListNotations.

(* The open fan of n triangles round v0: (0,1,2), (0,2,3), … Face f has the corner 3 f at v0. *)
Definition fan n : mesh :=
  Mesh n (fun h => if (h mod 3 =? 2) && (h / 3 + 1 <? n) then Some (h + 1)
                   else if (h mod 3 =? 0) && (0 <? h / 3) && (h / 3 <? n) then Some (h - 1) else None)
       (fun _ => false) (fun h => if h mod 3 =? 0 then 0 else h / 3 + h mod 3) (n + 2).
Definition tetrahedron : mesh :=
  Mesh 4 (fun h => nth h (map Some [8; 11; 3; 2; 10; 6; 5; 9; 0; 7; 4; 1]) None) (fun _ => false)
       (fun h => nth h [0; 1; 2; 0; 2; 3; 0; 3; 1; 1; 3; 2] 0) 4.
(* The vertex v gives the face of one corner away. *)
Definition give S v c := match split S v (fun h => h =? c) with Some S' => S' | None => S end.

(* The theorems are about something: the meshes of the counter-examples are well-formed. *)
Example the_fan_is_well_formed : well_formed (within (fan 4)).
Proof. apply (what_the_checker_accepts_is_well_formed _ (witness_of (fan 4))). vm_compute. auto. Qed.
Example the_tetrahedron_is_well_formed : well_formed (within tetrahedron).
Proof. apply (what_the_checker_accepts_is_well_formed _ (witness_of tetrahedron)). vm_compute. auto. Qed.

Section Walks.
Variables (S : mesh) (v : nat).
Let start (walk : nat -> list nat) := match half_edge_of S v with Some h => walk h | None => [] end.
Let at_v h := origin S h =? v.
Let if_at_v h := match h with Some h => if at_v h then Some h else None | None => None end.
Definition through_pairs_alone := start (fun h =>
  filter at_v (orbit (fun h => pair S (prev h)) (fun h => option_map next (pair S h)) (size S) h)).
Definition counting_every_face := start (orbit (ahead S) (behind S) (size S)).
Definition stopping_at_others :=
  start (orbit (fun h => if_at_v (ahead S h)) (fun h => if_at_v (behind S h)) (size S)).
Definition one_way := start (fun h => filter at_v (fst (go_ahead (ahead S) (size S) h h))).
End Walks.

(* The edge v0-v2 is torn at v0 only: v2 still has both faces, and the walk finds one. *)
Example pairs_alone_miss_a_face : let S := give (fan 2) 0 0 in
  through_pairs_alone S 2 = [2] /\ corners_of S 2 = [2; 4].
Proof. vm_compute. auto. Qed.
(* The walk from v0 crosses the ghost pair into f0, which is no longer its face. *)
Example every_face_is_too_many : let S := give (fan 2) 0 0 in
  counting_every_face S 0 = [3; 0] /\ corners_of S 0 = [3].
Proof. vm_compute. auto. Qed.
(* v0 still has both outer faces, and the walk stops between them. *)
Example stopping_misses_a_face : let S := give (fan 3) 0 3 in
  stopping_at_others S 0 = [0] /\ corners_of S 0 = [0; 6].
Proof. vm_compute. auto. Qed.
(* A vertex on the boundary, before any split: one direction reaches one end. *)
Example one_way_misses_a_face : one_way (fan 3) 3 = [5] /\ corners_of (fan 3) 3 = [5; 7].
Proof. vm_compute. auto. Qed.

(* Pair and ghost pair as two fields, and a torn edge that is separated again saves its pair again. A `mesh` cannot
   say so: it has one link. *)
Record two_fields := TwoFields { field_pair : nat -> option nat; field_ghost : nat -> option nat; field_origin : nat -> nat }.
Definition either t h := match field_pair t h with Some g => Some g | None => field_ghost t h end.
Definition give_overwriting t c new :=
  let moves h := h =? c in
  let parts h := match either t h with
    | Some g => xorb (moves h) (moves (next g)) || xorb (moves (next h)) (moves g) | None => false end in
  TwoFields (fun h => if parts h then None else field_pair t h)
            (fun h => if parts h then field_pair t h else field_ghost t h)
            (fun h => if moves h then new else field_origin t h).
Definition corners_in t n start v := filter (fun h => field_origin t h =? v)
  (orbit (fun h => either t (prev h)) (fun h => option_map next (either t h)) n start).
(* v0 gives f1 away, then v2 gives f0: "none" is saved over the ghost pair between them. *)
Example overwriting_misses_a_face :
  let t := TwoFields (link (fan 3)) (fun _ => None) (origin (fan 3)) in
  corners_in (give_overwriting (give_overwriting t 3 5) 2 6) 9 0 0 = [0] /\
  corners_of (give (give (fan 3) 0 3) 2 2) 0 = [0; 6].
Proof. vm_compute. auto. Qed.

(* Every edge between the two sets of faces is torn: in a tetrahedron whose v0 gives f0 away, v1-v2 too, whose ends
   agree. *)
Definition tear_round_face S f := Mesh (faces S) (link S)
  (fun h => match link S h with Some g => xorb (face h =? f) (face g =? f) | None => false end) (origin S) (vertices S).
Example tearing_all_edges_is_too_many : ~ well_formed (tear_round_face (give tetrahedron 0 0) 0).
Proof.
  intros W. pose proof (pair_agrees _ W 1 11 eq_refl) as [_ H].
  assert (torn (tear_round_face (give tetrahedron 0 0) 0) 1 = false) by (apply H; vm_compute; auto).
  vm_compute in *. discriminate.
Qed.

(* The theorems about operations are about something too: v0 of the fan gives f0 away and is sewn again, and the torn
   edge gets a point on both sides. *)
Definition triangles S := map (fun f => (origin S (3 * f), origin S (3 * f + 1), origin S (3 * f + 2))) (seq 0 (faces S)).
Definition torn_fan := give (fan 2) 0 0.
Example a_split_and_its_merge : triangles (fan 2) = [(0, 1, 2); (0, 2, 3)] /\
  triangles torn_fan = [(4, 1, 2); (0, 2, 3)] /\
  option_map triangles (merge torn_fan 4 0) = Some [(0, 1, 2); (0, 2, 3)] /\ merge torn_fan 4 1 = None.
Proof. vm_compute. auto. Qed.
Example a_point_on_a_tear :
  option_map triangles (insert_on_edge torn_fan 3) = Some [(1, 2, 6); (5, 2, 3); (6, 4, 1); (3, 0, 5)] /\
  option_map (fun S => corners_of S 2) (insert_on_edge torn_fan 3) = Some [1; 4].
Proof. vm_compute. auto. Qed.

(* A point on one side of a torn edge: what is whole on the other side can be linked to neither part. The walk finds one
   of the two faces of v2. *)
Definition on_one_side S h := insert
  (Mesh (faces S) (fun x => if (x =? h) || is h (link S x) then None else link S x) (torn S) (origin S) (vertices S))
  (boundary_cone S h).
Example a_point_on_one_side_misses_a_face : let S := on_one_side torn_fan 3 in
  triangles S = [(4, 1, 2); (5, 2, 3); (3, 0, 5)] /\ corners_of S 2 = [2].
Proof. vm_compute. auto. Qed.
(* One vertex for both sides: v5 is an end that agrees, and with the other end that does, the link is no tear (I7). *)
Definition one_for_both S h g := let c := edge_cone S h g in
  insert S (Cone (outline c) (succ c) (pred c) (forth c) (faces_then c) (cut c) (fun _ => false)).
Example one_vertex_for_both_sides_is_too_few : ~ well_formed (one_for_both torn_fan 3 2).
Proof.
  intros W. pose proof (pair_agrees _ W 1 3 eq_refl) as [_ H].
  assert (torn (one_for_both torn_fan 3 2) 1 = false) by (apply H; vm_compute; auto). vm_compute in *. discriminate.
Qed.
(* Children that are turned over: the mesh is well-formed, and not what the face was. *)
Definition turned_over : mesh :=
  Mesh 3 (fun h => nth h [Some 5; None; Some 6; Some 8; None; Some 0; Some 2; None; Some 3] None) (fun _ => false)
       (fun h => nth h [3; 1; 0; 3; 2; 1; 3; 0; 2] 0) 4.
Example turning_children_over_loses_the_outline :
  option_map triangles (insert_in_face (fan 1) 0) = Some [(3, 0, 1); (3, 1, 2); (3, 2, 0)] /\
  triangles turned_over = [(3, 1, 0); (3, 2, 1); (3, 0, 2)] /\
  well_formed (within turned_over) /\
  forall pieces parent, ~ keeps_outlines (fan 1) turned_over (fun _ => False) (eq 0) pieces parent.
Proof.
  do 2 (split; [vm_compute; auto|]). split.
  - apply (what_the_checker_accepts_is_well_formed _ (witness_of turned_over)). vm_compute. auto.
  - intros pieces parent K. assert (H0 : 0 < size (fan 1)) by (vm_compute; auto).
    destruct (is_one _ _ _ _ _ _ K 0) as (x & E & Hx & Hy); auto.
    destruct (is_of_parent _ _ _ _ _ _ K 0 x) as [Hs _]; [auto|rewrite E; left; auto|].
    change (x < 9) in Hs. do 9 (destruct x as [|x]; [discriminate|]). lia.
Qed.
