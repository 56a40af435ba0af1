(* The state of a torn mesh, when it is well-formed, and what follows from that.

   A state is what `Mesh` stores: for each half-edge its origin, its link, and whether that is torn. `well_formed` is
   I2 to I8, and I11 to I13 of the root complex (see src/mesh/invariants.md for the numbers and the words). From these
   follow I10, the walk round a vertex is exact, and I3 and I11 to I13 of the torn mesh. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk.
Import ListNotations.

(* ---- half-edges of triangles ---- *)
Definition face h := h / 3.
Definition next h := if h mod 3 =? 2 then h - 2 else h + 1.
Definition prev h := if h mod 3 =? 0 then h + 2 else h - 1.

Lemma corner_form : forall h, exists q, h = 3 * q \/ h = 3 * q + 1 \/ h = 3 * q + 2.
Proof.
  intros h. exists (h / 3). pose proof (Nat.div_mod h 3). pose proof (Nat.mod_upper_bound h 3). lia.
Qed.
Lemma mod_form : forall q r, r < 3 -> (3 * q + r) mod 3 = r.
Proof. intros. rewrite Nat.add_comm, Nat.mul_comm, Nat.mod_add, Nat.mod_small; lia. Qed.
Lemma mod_form0 : forall q, (3 * q) mod 3 = 0.
Proof. intros. replace (3 * q) with (3 * q + 0) by lia. apply mod_form; lia. Qed.
Ltac form := intros; unfold next, prev; rewrite ?mod_form0, ?mod_form by lia; cbv [Nat.eqb]; lia.
Lemma next0 : forall q, next (3 * q) = 3 * q + 1. Proof. form. Qed.
Lemma next1 : forall q, next (3 * q + 1) = 3 * q + 2. Proof. form. Qed.
Lemma next2 : forall q, next (3 * q + 2) = 3 * q. Proof. form. Qed.
Lemma prev0 : forall q, prev (3 * q) = 3 * q + 2. Proof. form. Qed.
Lemma prev1 : forall q, prev (3 * q + 1) = 3 * q. Proof. form. Qed.
Lemma prev2 : forall q, prev (3 * q + 2) = 3 * q + 1. Proof. form. Qed.
Ltac corner h :=
  let q := fresh "q" in destruct (corner_form h) as (q & [ -> | [ -> | -> ]]);
  rewrite ?next0, ?next1, ?next2, ?prev0, ?prev1, ?prev2, ?next0, ?next1, ?next2.
Lemma next_prev : forall h, next (prev h) = h.
Proof. intros h. corner h; auto. Qed.
Lemma prev_next : forall h, prev (next h) = h.
Proof. intros h. corner h; rewrite ?prev0, ?prev1, ?prev2; auto. Qed.
Lemma next_below : forall h F, h < 3 * F -> next h < 3 * F.
Proof. intros h F. corner h; lia. Qed.
Lemma prev_below : forall h F, h < 3 * F -> prev h < 3 * F.
Proof. intros h F. corner h; lia. Qed.

(* ---- the state ---- *)
(* Each link is a pair, or torn and then a ghost pair: one link and one mark, as in src/mesh.rs. *)
Record mesh := Mesh {
  faces : nat; link : nat -> option nat; torn : nat -> bool; origin : nat -> nat; vertices : nat }.
Definition size S := 3 * faces S.
Definition pair S h := if torn S h then None else link S h.
Definition ghost_pair S h := if torn S h then link S h else None.
Definition pair_or_ghost S h := match pair S h with Some g => Some g | None => ghost_pair S h end.
Definition ahead S h := pair_or_ghost S (prev h).
Definition behind S h := option_map next (pair_or_ghost S h).
(* I9: the smallest half-edge that starts at a vertex. *)
Definition half_edge_of S v := find (fun h => origin S h =? v) (seq 0 (size S)).
(* Mesh::corners_of: the whole orbit, without stopping; of it, what still has the vertex. *)
Definition corners_of S v :=
  match half_edge_of S v with
  | None => []
  | Some h => filter (fun h => origin S h =? v) (orbit (ahead S) (behind S) (size S) h)
  end.

(* Two corners have the same root if turns through links lead from one to the other. *)
Definition same_root (lk : nat -> option nat) := joined (fun h => lk (prev h)).

(* The root complex is an oriented manifold: a property of the links alone, which the builder establishes. I14, no
   bow-tie, is built into `same_root`: vertices of the root complex are orbits. *)
Record manifold (F : nat) (lk : nat -> option nat) : Prop := {
  link_in_range : forall h g, lk h = Some g -> h < 3 * F /\ g < 3 * F;                             (* I2 *)
  link_is_involution : forall h g, lk h = Some g -> lk g = Some h;                                 (* I4 *)
  link_leaves_face : forall h g, lk h = Some g -> face h <> face g;                                (* I4 *)
  three_roots : forall h, h < 3 * F -> ~ same_root lk h (next h);                                  (* I3 *)
  root_edge_once : forall h g, h < 3 * F -> g < 3 * F ->
    same_root lk h g -> same_root lk (next h) (next g) -> h = g;                                   (* I11 *)
  root_opposites_linked : forall h g, h < 3 * F -> g < 3 * F ->
    same_root lk h (next g) -> same_root lk (next h) g -> lk h = Some g;                           (* I12 *)
  root_faces_differ : forall h g, h < 3 * F -> g < 3 * F ->
    same_root lk h g -> same_root lk (next h) (prev g) -> same_root lk (prev h) (next g) -> False  (* I13 *)
}.

(* The labels of the corners agree with the links and their marks. *)
Record well_formed (S : mesh) : Prop := {
  is_manifold : manifold (faces S) (link S);
  origin_in_range : forall h, h < size S -> origin S h < vertices S;                               (* I2 *)
  torn_both_sides : forall h g, link S h = Some g -> torn S h = torn S g;                          (* I5 *)
  boundary_not_torn : forall h, link S h = None -> torn S h = false;
  pair_agrees : forall h g, link S h = Some g ->
    (torn S h = false <-> origin S h = origin S (next g) /\ origin S (next h) = origin S g);      (* I6, I7 *)
  one_root : forall h g, h < size S -> g < size S -> origin S h = origin S g -> same_root (link S) h g  (* I8 *)
}.

Lemma pair_or_ghost_is_link : forall S h, pair_or_ghost S h = link S h.
Proof. intros. unfold pair_or_ghost, pair, ghost_pair. destruct (torn S h), (link S h); auto. Qed.

Section Facts.
Variable S : mesh.
Hypothesis W : well_formed S.
Let M := is_manifold S W.

Lemma ahead_range : forall x y, ahead S x = Some y -> x < size S /\ y < size S.
Proof.
  unfold ahead, size. intros x y H. rewrite pair_or_ghost_is_link in H.
  destruct (link_in_range _ _ M _ _ H) as [H1 H2]. split; auto.
  rewrite <- (next_prev x). apply next_below; auto.
Qed.
Lemma ahead_behind : forall x y, ahead S x = Some y <-> behind S y = Some x.
Proof.
  unfold ahead, behind. intros x y. rewrite !pair_or_ghost_is_link. split; intros H.
  - rewrite (link_is_involution _ _ M _ _ H). simpl. rewrite next_prev. auto.
  - destruct (link S y) as [g|] eqn:E; try discriminate. injection H as <-.
    rewrite prev_next. apply (link_is_involution _ _ M); auto.
Qed.
Lemma joined_is_same_root : forall x y, joined (ahead S) x y <-> same_root (link S) x y.
Proof.
  unfold same_root, joined. intros; split; induction 1;
    try (apply rt_refl); try (eapply rt_trans; eassumption);
    apply rt_step; unfold step, ahead in *; rewrite ?pair_or_ghost_is_link in *; auto.
Qed.

(* Without the filter of the walk, the orbit of a corner is all corners of its root. *)
Lemma orbit_is_root : forall h g, h < size S ->
  (In g (orbit (ahead S) (behind S) (size S) h) <-> g < size S /\ same_root (link S) h g).
Proof.
  intros h g Hh. destruct (orbit_lists_each_once (ahead S) (behind S) (size S) ahead_range ahead_behind (size S) h) as [_ ->]; auto.
  rewrite joined_is_same_root. split; [|tauto]. intros H. split; auto.
  apply joined_is_same_root in H. eapply joined_below; eauto using ahead_range.
Qed.

(* I10: the walk lists exactly the corners of the vertex, each once. *)
Theorem walk_lists_exactly_the_corners : forall v,
  NoDup (corners_of S v) /\ forall h, In h (corners_of S v) <-> h < size S /\ origin S h = v.
Proof.
  intros v. unfold corners_of. destruct (half_edge_of S v) as [s|] eqn:Es.
  - apply find_some in Es. destruct Es as [Hs Hv]. apply in_seq in Hs. apply Nat.eqb_eq in Hv. split.
    { apply NoDup_filter. apply (orbit_lists_each_once _ _ _ ahead_range ahead_behind); lia. }
    intros h. rewrite filter_In, Nat.eqb_eq, orbit_is_root by lia. split; [tauto|].
    intros [Hh Ho]. repeat split; auto. apply (one_root _ W); try lia.
  - split. constructor. intros h. split; [intros []|]. intros [Hh Ho].
    pose proof (find_none _ _ Es h) as Hn. simpl in Hn.
    rewrite Ho, Nat.eqb_refl in Hn. exfalso. assert (true = false); [|discriminate].
    apply Hn. apply in_seq. lia.
Qed.
(* The loop of the walk ends by itself: fuel beyond one for each corner is left over. *)
Theorem walk_ends : forall fuel h, size S <= fuel -> h < size S ->
  orbit (ahead S) (behind S) fuel h = orbit (ahead S) (behind S) (size S) h.
Proof. exact (orbit_ends (ahead S) (behind S) (size S) ahead_range ahead_behind). Qed.

(* I3. *)
Theorem three_vertices : forall h, h < size S -> origin S h <> origin S (next h).
Proof.
  intros h Hh E. apply (three_roots _ _ M h Hh). apply (one_root _ W); auto. apply next_below; auto.
Qed.
(* I11. *)
Theorem directed_edge_once : forall h g, h < size S -> g < size S ->
  origin S h = origin S g -> origin S (next h) = origin S (next g) -> h = g.
Proof.
  intros. apply (root_edge_once _ _ M); auto; apply (one_root _ W); auto; apply next_below; auto.
Qed.
(* I12. *)
Theorem opposites_are_paired : forall h g, h < size S -> g < size S ->
  origin S h = origin S (next g) -> origin S (next h) = origin S g -> pair S h = Some g.
Proof.
  intros h g Hh Hg H1 H2.
  assert (E : link S h = Some g).
  { apply (root_opposites_linked _ _ M); auto; apply (one_root _ W); auto; apply next_below; auto. }
  unfold pair. destruct (pair_agrees _ W _ _ E) as [_ Ha]. rewrite Ha; auto.
Qed.
(* I13, of two faces back to back; that no two lie on each other follows from I11. *)
Theorem no_two_faces_back_to_back : forall h g, h < size S -> g < size S ->
  origin S h = origin S g -> origin S (next h) = origin S (prev g) -> origin S (prev h) = origin S (next g) -> False.
Proof.
  intros h g Hh Hg H1 H2 H3.
  apply (root_faces_differ _ _ M h g); auto; apply (one_root _ W); auto; try apply next_below; try apply prev_below; auto.
Qed.
End Facts.
(* The marks are a function of the links and the origins. *)
Lemma marks_follow : forall S S', well_formed S -> well_formed S' -> link S' = link S ->
  (forall h, h < size S -> origin S' h = origin S h) -> forall h, torn S' h = torn S h.
Proof.
  intros S S' W W' El Eo h. destruct (link S h) as [g|] eqn:E.
  - pose proof (pair_agrees _ W _ _ E) as Ha. destruct (link_in_range _ _ (is_manifold _ W) _ _ E) as [Hh Hg].
    rewrite <- El in E. pose proof (pair_agrees _ W' _ _ E) as Ha'. rewrite !Eo in Ha' by (auto; apply next_below; auto).
    destruct (torn S h), (torn S' h); intuition congruence.
  - rewrite (boundary_not_torn _ W _ E). apply (boundary_not_torn _ W'). congruence.
Qed.
