(* The builder: which triangles it accepts, and that these are the manifolds of the theorems.

   `build` is the definition, written down as loops over half-edges: it says what `Mesh::build` must accept and how it
   must link, and not how to do so in linear time. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split Merge Cone.
Import ListNotations.

Section Build.
Variables (V F : nat) (o : nat -> nat).
Let n := 3 * F.
(* The half-edge that runs the other way between the same vertices. *)
Definition opposite h := find (fun g => (o g =? o (next h)) && (o (next g) =? o h)) (seq 0 n).
Definition built := Mesh F (fun h => if h <? n then opposite h else None) (fun _ => false) o V.
Definition all (p : nat -> bool) := forallb p (seq 0 n).
Definition accepts :=
  all (fun h => (o h <? V) && negb (o h =? o (next h)) && all (fun g =>
    (negb ((o h =? o g) && (o (next h) =? o (next g))) || (h =? g)) &&               (* an edge has a side once *)
    (negb (o h =? o g) || mem g (orbit (ahead built) (behind built) n h)) &&          (* a vertex has one fan *)
    negb ((o h =? o g) && (o (next h) =? o (prev g)) && (o (prev h) =? o (next g))))). (* no face lies on another *)
Definition build := if accepts then Some built else None.

(* The same in words of logic. *)
Record accepted : Prop := {
  in_range : forall h, h < n -> o h < V;
  distinct : forall h, h < n -> o h <> o (next h);
  side_once : forall h g, h < n -> g < n -> o h = o g -> o (next h) = o (next g) -> h = g;
  one_fan : forall h g, h < n -> g < n -> o h = o g -> In g (orbit (ahead built) (behind built) n h);
  no_pillow : forall h g, h < n -> g < n -> o h = o g -> o (next h) = o (prev g) -> o (prev h) = o (next g) -> False }.
Lemma all_spec : forall p, all p = true <-> forall h, h < n -> p h = true.
Proof.
  intros p. unfold all. rewrite forallb_forall. split; intros H h Hh; apply H; [apply in_seq|apply in_seq in Hh]; lia.
Qed.
Lemma accepts_spec : accepts = true <-> accepted.
Proof.
  unfold accepts. rewrite all_spec. split.
  - intros H.
    assert (H1 : forall h, h < n -> o h < V /\ o h <> o (next h)).
    { intros h Hh. specialize (H h Hh). rewrite !andb_true_iff, Nat.ltb_lt, negb_true_iff, Nat.eqb_neq in H. tauto. }
    assert (H2 : forall h g, h < n -> g < n ->
      (o h = o g -> o (next h) = o (next g) -> h = g) /\
      (o h = o g -> In g (orbit (ahead built) (behind built) n h)) /\
      (o h = o g -> o (next h) = o (prev g) -> o (prev h) = o (next g) -> False)).
    { intros h g Hh Hg. specialize (H h Hh). rewrite !andb_true_iff, all_spec in H. destruct H as [_ H].
      specialize (H g Hg). rewrite !andb_true_iff, !orb_true_iff, !negb_true_iff, Nat.eqb_eq, mem_in in H.
      destruct H as [[Ha Hb] Hc]. repeat split.
      - intros E1 E2. rewrite E1, E2, !Nat.eqb_refl in Ha. destruct Ha; [discriminate|auto].
      - intros E. rewrite E, Nat.eqb_refl in Hb. destruct Hb; [discriminate|auto].
      - intros E1 E2 E3. rewrite E1, E2, E3, !Nat.eqb_refl in Hc. discriminate. }
    constructor; intros; try (apply H1; auto; fail); eapply (H2 h g); eauto.
  - intros A h Hh. rewrite !andb_true_iff, Nat.ltb_lt, negb_true_iff, Nat.eqb_neq, all_spec.
    split; [split; [apply A|apply A]; auto|]. intros g Hg.
    rewrite !andb_true_iff, !orb_true_iff, !negb_true_iff, Nat.eqb_eq, mem_in. repeat split.
    + destruct (Nat.eqb_spec (o h) (o g)), (Nat.eqb_spec (o (next h)) (o (next g))); simpl; auto.
      right. apply (side_once A); auto.
    + destruct (Nat.eqb_spec (o h) (o g)); auto. right. apply (one_fan A); auto.
    + destruct (Nat.eqb_spec (o h) (o g)), (Nat.eqb_spec (o (next h)) (o (prev g))),
        (Nat.eqb_spec (o (prev h)) (o (next g))); simpl; auto. exfalso. apply (no_pillow A h g); auto.
Qed.

Lemma opposite_ends : forall h g, opposite h = Some g -> g < n /\ o g = o (next h) /\ o (next g) = o h.
Proof.
  intros h g E. apply find_some in E. destruct E as [Hs E]. apply in_seq in Hs.
  rewrite andb_true_iff, !Nat.eqb_eq in E. split; [lia|tauto].
Qed.
Lemma opposite_found : forall h g, g < n -> o g = o (next h) -> o (next g) = o h ->
  exists k, opposite h = Some k.
Proof.
  intros h g Hg E1 E2. destruct (opposite h) as [k|] eqn:E; eauto.
  assert (Hs : In g (seq 0 n)) by (apply in_seq; lia). pose proof (find_none _ _ E g Hs) as H. simpl in H.
  rewrite E1, E2, !Nat.eqb_refl in H. discriminate.
Qed.
Lemma link_built : forall h g, link built h = Some g <-> h < n /\ opposite h = Some g.
Proof. intros h g. simpl. destruct (Nat.ltb_spec h n); split; intros; try tauto; try discriminate. lia. Qed.

Section Accepted.
Hypothesis A : accepted.
Lemma built_involution : forall h g, link built h = Some g -> link built g = Some h.
Proof.
  intros h g E. apply link_built in E. destruct E as [Hh E]. apply opposite_ends in E. destruct E as (Hg & E1 & E2).
  destruct (opposite_found g h) as (k & Ek); auto. apply link_built. split; auto. rewrite Ek. f_equal.
  apply opposite_ends in Ek. destruct Ek as (Hk & E3 & E4). apply (side_once A); auto; congruence.
Qed.
Lemma built_range : forall x y, ahead built x = Some y -> x < n /\ y < n.
Proof.
  intros x y E. unfold ahead in E. rewrite pair_or_ghost_is_link in E. apply link_built in E. destruct E as [Hx E].
  apply opposite_ends in E. split; [|tauto]. rewrite <- (next_prev x). apply next_below; auto.
Qed.
Lemma built_behind : forall x y, ahead built x = Some y <-> behind built y = Some x.
Proof.
  intros x y. unfold ahead, behind. rewrite !pair_or_ghost_is_link. split; intros E.
  - apply built_involution in E. rewrite E. simpl. rewrite next_prev. auto.
  - destruct (link built y) as [g|] eqn:Eg; [|discriminate]. injection E as <-. rewrite prev_next.
    apply built_involution; auto.
Qed.
Lemma root_is_vertex : forall h g, h < n -> g < n -> (same_root (link built) h g <-> o h = o g).
Proof.
  intros h g Hh Hg. split.
  - clear Hh Hg. induction 1 as [x y [E|E]| |]; try congruence; apply link_built in E; destruct E as [_ E];
      apply opposite_ends in E; destruct E as (_ & E & _); rewrite next_prev in E; auto.
  - intros E. apply (one_fan A) in E; auto.
    destruct (orbit_lists_each_once (ahead built) (behind built) n built_range built_behind n h) as [_ H]; auto.
    apply H in E. revert E. clear. unfold same_root, joined. induction 1 as [x y [E|E]| |];
      [apply rt_step; left|apply rt_step; right|apply rt_refl|eapply rt_trans; eauto];
      unfold ahead in E; rewrite pair_or_ghost_is_link in E; auto.
Qed.
Lemma built_is_well_formed : well_formed built.
Proof.
  assert (Hn : forall h, h < n -> next h < n) by (intros; apply next_below; auto).
  assert (Hp : forall h, h < n -> prev h < n) by (intros; apply prev_below; auto).
  constructor; auto.
  - constructor.
    + intros h g E. apply link_built in E. destruct E as [Hh E]. apply opposite_ends in E. tauto.
    + exact built_involution.
    + intros h g E Ef. apply link_built in E. destruct E as [Hh E]. apply opposite_ends in E. destruct E as (Hg & E1 & E2).
      destruct (of_one_face _ _ Ef) as [->|[->| ->]].
      * apply (distinct A h); auto.
      * rewrite next_next in E2. apply (distinct A (prev h)); auto. rewrite next_prev; auto.
      * apply (distinct A (next h)); auto. rewrite next_next; auto.
    + intros h Hh E. apply root_is_vertex in E; auto. apply (distinct A h); auto.
    + intros h g Hh Hg E1 E2. apply root_is_vertex in E1, E2; auto. apply (side_once A); auto.
    + intros h g Hh Hg E1 E2. apply root_is_vertex in E1, E2; auto. apply link_built. split; auto.
      destruct (opposite_found h g) as (k & Ek); auto. rewrite Ek. f_equal. apply opposite_ends in Ek.
      destruct Ek as (Hk & E3 & E4). apply (side_once A); auto; congruence.
    + intros h g Hh Hg E1 E2 E3. apply root_is_vertex in E1, E2, E3; auto. apply (no_pillow A h g); auto.
  - apply (in_range A).
  - intros h g E. apply link_built in E. destruct E as [_ E]. apply opposite_ends in E. simpl. intuition congruence.
  - intros h g Hh Hg E. apply root_is_vertex; auto.
Qed.
End Accepted.
End Build.

(* What is accepted is well-formed, and has no tear. *)
Theorem build_establishes_well_formed : forall V F o S, build V F o = Some S ->
  well_formed S /\ vertices S = V /\ faces S = F /\ origin S = o /\ forall h, torn S h = false.
Proof.
  intros V F o S. unfold build. destruct (accepts V F o) eqn:E; [|discriminate]. intros H. injection H as <-.
  apply accepts_spec in E. split; [apply built_is_well_formed; auto|auto].
Qed.
(* Every well-formed mesh without a tear is accepted, and gets the links that it has. *)
Theorem build_accepts_every_manifold : forall S, well_formed S -> (forall h, torn S h = false) ->
  exists S', build (vertices S) (faces S) (origin S) = Some S' /\ forall h, link S' h = link S h.
Proof.
  intros S W T. set (o := origin S). set (S' := built (vertices S) (faces S) o).
  assert (M := is_manifold S W).
  assert (Hlink : forall h, link S' h = link S h).
  { intros h. destruct (link S h) as [g|] eqn:E.
    - destruct (link_in_range _ _ M _ _ E) as [Hh Hg]. apply link_built. split; auto.
      destruct (pair_agrees S W _ _ E) as [Ha _]. destruct (Ha (T h)) as [E1 E2].
      destruct (opposite_found (faces S) o h g) as (k & Ek); auto. rewrite Ek. f_equal.
      apply opposite_ends in Ek. destruct Ek as (Hk & E3 & E4).
      pose proof (opposites_are_paired S W h k Hh Hk (eq_sym E4) (eq_sym E3)) as Hp. unfold pair in Hp.
      rewrite T in Hp. congruence.
    - destruct (link S' h) as [k|] eqn:Ek; auto. apply link_built in Ek. destruct Ek as [Hh Ek].
      apply opposite_ends in Ek. destruct Ek as (Hk & E3 & E4).
      pose proof (opposites_are_paired S W h k Hh Hk (eq_sym E4) (eq_sym E3)) as Hp. unfold pair in Hp.
      rewrite T in Hp. congruence. }
  exists S'. split; auto. unfold build. rewrite (proj2 (accepts_spec _ _ _)); auto. constructor.
  - apply (origin_in_range S W).
  - apply (three_vertices S W).
  - apply (directed_edge_once S W).
  - intros h g Hh Hg E. fold S'.
    assert (Ha : forall x, ahead S' x = ahead S x) by (intros x; unfold ahead; rewrite !pair_or_ghost_is_link; auto).
    assert (Hb : forall x, behind S' x = behind S x).
    { intros x; unfold behind; rewrite !pair_or_ghost_is_link, Hlink; auto. }
    destruct (orbit_lists_each_once (ahead S') (behind S') (size S)) with (fuel := size S) (first := h) as [_ H]; auto.
    + intros x y. rewrite Ha. apply (ahead_range S W).
    + intros x y. rewrite Ha, Hb. apply (ahead_behind S W).
    + apply H. pose proof (one_root S W h g Hh Hg E) as J. apply (joined_is_same_root S) in J. revert J. clear - Ha.
      unfold joined. induction 1 as [x y [E|E]| |];
        [apply rt_step; left|apply rt_step; right|apply rt_refl|eapply rt_trans; eauto]; rewrite Ha; auto.
  - apply (no_two_faces_back_to_back S W).
Qed.

(* Mesh::build_torn: panels that were never one. The whole is built as it will be when all is sewn, and then the corners
   get the vertices of their panels; a link is torn where its sides do not agree on both. *)
Definition panels S V o := Mesh (faces S) (link S) (fun h => match link S h with
  | Some g => negb ((o h =? o (next g)) && (o (next h) =? o g))
  | None => false
  end) o V.
(* They are well-formed if corners of one vertex had one in the whole, so that all that holds of edits holds of sewing. *)
Theorem panels_are_well_formed : forall S V o, well_formed S ->
  (forall h, h < size S -> o h < V) ->
  (forall h g, h < size S -> g < size S -> o h = o g -> origin S h = origin S g) ->
  well_formed (panels S V o).
Proof.
  intros S V o W Hr Ho. constructor; simpl.
  - apply (is_manifold S W).
  - exact Hr.
  - intros h g E. rewrite E, (link_is_involution _ _ (is_manifold S W) _ _ E). f_equal.
    rewrite (Nat.eqb_sym (o g)), (Nat.eqb_sym (o (next g))). apply andb_comm.
  - intros h E. rewrite E. auto.
  - intros h g E. rewrite E, negb_false_iff, andb_true_iff, !Nat.eqb_eq. reflexivity.
  - intros h g Hh Hg E. apply (one_root S W); auto.
Qed.
(* Two vertices that are one in the whole can be merged. *)
Theorem panels_can_be_sewn : forall S V o h g, well_formed S ->
  (forall h, h < size S -> o h < V) ->
  (forall h g, h < size S -> g < size S -> o h = o g -> origin S h = origin S g) ->
  h < size S -> g < size S -> origin S h = origin S g -> o h <> o g ->
  exists S', merge (panels S V o) (o h) (o g) = Some S'.
Proof.
  intros S V o h g W Hr Ho Hh Hg E Hn. apply merge_joins_one_root; [apply panels_are_well_formed; auto|].
  split; auto. exists h, g. repeat split; auto. apply (one_root S W); auto.
Qed.
