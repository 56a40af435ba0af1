(* The split: a vertex becomes two, and each of its faces goes to one of them.

   `split` does what `by_plane` and `commit` of src/split.rs do: it walks round the vertex, and looks across both edges
   of each corner that moved. It keeps the mesh well-formed, is refused if and only if a side would be empty (I22 needs
   no proof: there is no other state), tears the links between the sides alone, and changes nothing but what I16 says.
   `split_vertex` is `split::vertex`, which takes a list of faces, and so has two more reasons to refuse. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State.
Import ListNotations.

Definition set {A} (f : nat -> A) k a := fun x => if x =? k then a else f x.
Definition mem h l := existsb (Nat.eqb h) l.

(* One of the two edges of a corner that moved; `turn` says which corner of the link lies across. *)
Definition tear_edge (lk : nat -> option nat) (o : nat -> nat) new (t : nat -> bool) moved (turn : bool) :=
  match (if t moved then None else lk moved) with
  | None => t
  | Some stayed =>
      let across := if turn then next stayed else stayed in
      if o across =? new then t else set (set t moved true) stayed true
  end.
Definition tear_corner lk o new t c := tear_edge lk o new (tear_edge lk o new t (prev c) false) c true.

(* The faces whose corners are in `moves` get a new vertex, the last one. *)
Definition split S v (moves : nat -> bool) : option mesh :=
  let noted := filter moves (corners_of S v) in
  let stays := filter (fun h => negb (moves h)) (corners_of S v) in
  match noted, stays with
  | [], _ | _, [] => None
  | _, _ =>
      let o := fun h => if mem h noted then vertices S else origin S h in
      Some (Mesh (faces S) (link S) (fold_left (tear_corner (link S) o (vertices S)) noted (torn S)) o (1 + vertices S))
  end.
(* The faces of a list get it. Refused if one is listed twice, or has no corner at the vertex. *)
Fixpoint repeats l := match l with [] => false | f :: l => mem f l || repeats l end.
Definition at_vertex S v f := (f <? faces S) && existsb (fun h => origin S h =? v) [3 * f; 3 * f + 1; 3 * f + 2].
Definition split_vertex S v faces : option mesh :=
  if existsb (fun f => negb (at_vertex S v f)) faces || repeats faces then None
  else split S v (fun h => mem (face h) faces).

Lemma mem_in : forall h l, mem h l = true <-> In h l.
Proof.
  intros. unfold mem. rewrite existsb_exists. split.
  - intros (x & Hx & E). apply Nat.eqb_eq in E. subst; auto.
  - intros. exists h. rewrite Nat.eqb_refl. auto.
Qed.

Section Split.
Variable S : mesh.
Hypothesis W : well_formed S.
Let M := is_manifold S W.
Variables (v : nat) (moved : list nat).
Hypothesis moved_at_v : forall h, In h moved -> h < size S /\ origin S h = v.
Let m h := mem h moved.
Let o h := if m h then vertices S else origin S h.
Let tear := tear_corner (link S) o (vertices S).

(* A link is separated if at one of its ends one corner moved and the other stayed. *)
Definition separated h :=
  match link S h with
  | Some g => xorb (m h) (m (next g)) || xorb (m (next h)) (m g)
  | None => false
  end.
Lemma separated_symmetric : forall h g, link S h = Some g -> separated h = separated g.
Proof.
  intros h g H. unfold separated. rewrite H, (link_is_involution _ _ M _ _ H).
  rewrite (xorb_comm (m g)), (xorb_comm (m (next g))). apply orb_comm.
Qed.

Lemma link_below : forall h g, link S h = Some g -> h < size S /\ g < size S.
Proof. exact (link_in_range _ _ M). Qed.
Lemma o_new : forall h, h < size S -> (o h =? vertices S) = m h.
Proof.
  intros h Hh. unfold o. destruct (m h). apply Nat.eqb_refl.
  apply Nat.eqb_neq. pose proof (origin_in_range _ W h Hh). lia.
Qed.

(* What holds of the marks while corners are looked at. *)
Definition on_the_way (t : nat -> bool) :=
  (forall h, torn S h = true -> t h = true) /\
  (forall h, t h = true -> torn S h = true \/ separated h = true) /\
  (forall h g, link S h = Some g -> t h = t g).

Lemma tear_edge_on_the_way : forall t e (turn : bool),
  on_the_way t -> m (if turn then e else next e) = true -> on_the_way (tear_edge (link S) o (vertices S) t e turn).
Proof.
  intros t e turn (Ha & Hb & Hc) Hm. unfold tear_edge.
  destruct (t e) eqn:Et; [repeat split; auto|].
  destruct (link S e) as [g|] eqn:E; [|repeat split; auto].
  destruct (link_below _ _ E) as [He Hg].
  destruct (o (if turn then next g else g) =? vertices S) eqn:Eo; [repeat split; auto|].
  assert (Hs : separated e = true).
  { unfold separated. rewrite E. destruct turn; rewrite o_new in Eo; auto; try (apply next_below; auto).
    - rewrite Hm, Eo. auto.
    - rewrite Hm, Eo. simpl. apply orb_true_r. }
  split; [|split].
  - intros h Hh. unfold set. destruct (h =? g), (h =? e); auto.
  - intros h. unfold set. destruct (h =? g) eqn:Eg.
    + apply Nat.eqb_eq in Eg. subst h. intros _. right. rewrite <- (separated_symmetric _ _ E). auto.
    + destruct (h =? e) eqn:Ee; auto. apply Nat.eqb_eq in Ee. subst h. auto.
  - intros h k Hk. unfold set.
    destruct (h =? g) eqn:E1; [apply Nat.eqb_eq in E1; subst h|].
    { assert (k = e) by (rewrite (link_is_involution _ _ M _ _ E) in Hk; congruence). subst k.
      rewrite Nat.eqb_refl. destruct (e =? g); auto. }
    destruct (h =? e) eqn:E2; [apply Nat.eqb_eq in E2; subst h|].
    { assert (k = g) by congruence. subst k. rewrite Nat.eqb_refl. auto. }
    destruct (k =? g) eqn:E3; [apply Nat.eqb_eq in E3; subst k|].
    { exfalso. apply Nat.eqb_neq in E2. apply E2.
      apply (link_is_involution _ _ M) in Hk, E. congruence. }
    destruct (k =? e) eqn:E4; [apply Nat.eqb_eq in E4; subst k|].
    { exfalso. apply Nat.eqb_neq in E1. apply E1. apply (link_is_involution _ _ M) in Hk. congruence. }
    auto.
Qed.
Lemma tear_edge_untears_nothing : forall lk o' new t e (turn : bool) h, t h = true -> tear_edge lk o' new t e turn h = true.
Proof.
  intros. unfold tear_edge. destruct (if t e then None else lk e); auto.
  destruct (o' _ =? new); auto. unfold set. destruct (h =? _), (h =? e); auto.
Qed.
Lemma tear_edge_tears : forall t e (turn : bool) g, link S e = Some g ->
  m (if turn then next g else g) = false -> tear_edge (link S) o (vertices S) t e turn e = true.
Proof.
  intros t e turn g E Hm. unfold tear_edge. destruct (t e) eqn:Et; auto. rewrite E.
  destruct (link_below _ _ E) as [He Hg].
  rewrite o_new; [rewrite Hm; unfold set; rewrite Nat.eqb_refl; destruct (e =? g); auto|].
  destruct turn; auto. apply next_below; auto.
Qed.

Lemma tear_corner_on_the_way : forall t c, on_the_way t -> In c moved -> on_the_way (tear t c).
Proof.
  intros t c Ht Hc. apply mem_in in Hc. unfold tear, tear_corner.
  apply tear_edge_on_the_way; auto. apply tear_edge_on_the_way; auto. rewrite next_prev. auto.
Qed.
Lemma loop_on_the_way : forall l t, on_the_way t -> (forall c, In c l -> In c moved) -> on_the_way (fold_left tear l t).
Proof.
  induction l; intros t Ht Hl; simpl; auto. apply IHl; auto using in_cons.
  apply tear_corner_on_the_way; auto. apply Hl. left; auto.
Qed.
Lemma loop_untears_nothing : forall l t h, t h = true -> fold_left tear l t h = true.
Proof.
  induction l; intros; simpl; auto. apply IHl. unfold tear, tear_corner.
  apply tear_edge_untears_nothing, tear_edge_untears_nothing; auto.
Qed.
Lemma loop_tears : forall l t c, In c l ->
  (forall g, link S (prev c) = Some g -> m g = false -> fold_left tear l t (prev c) = true) /\
  (forall g, link S c = Some g -> m (next g) = false -> fold_left tear l t c = true).
Proof.
  induction l; intros t c Hc; [destruct Hc|]. destruct Hc as [->|Hc]; simpl; [|apply IHl; auto]. split; intros g E Hm; apply loop_untears_nothing.
  - unfold tear, tear_corner. apply tear_edge_untears_nothing. eapply tear_edge_tears; eauto.
  - unfold tear, tear_corner. eapply (tear_edge_tears _ c true); eauto.
Qed.

(* The loop over moved corners tears exactly what is separated. *)
Lemma loop_tears_what_is_separated : forall h, fold_left tear moved (torn S) h = torn S h || separated h.
Proof.
  intros h.
  assert (on_the_way (torn S)) as H0 by (repeat split; auto using (torn_both_sides _ W)).
  pose proof (loop_on_the_way moved _ H0 (fun c H => H)) as (Ha & Hb & Hc).
  apply eq_true_iff_eq. rewrite orb_true_iff. split; [apply Hb|].
  intros [Ht|Hs]; auto. unfold separated in Hs. destruct (link S h) as [g|] eqn:E; [|discriminate].
  pose proof (link_is_involution _ _ M _ _ E) as E'.
  apply orb_true_iff in Hs. destruct Hs as [Hs|Hs].
  - destruct (m h) eqn:E1, (m (next g)) eqn:E2; try discriminate; apply mem_in in E1 || apply mem_in in E2.
    + eapply (loop_tears moved (torn S) h); eauto.
    + rewrite (Hc _ _ E). rewrite <- (prev_next g) at 1.
      eapply (loop_tears moved (torn S) (next g)); eauto. rewrite prev_next; eauto.
  - destruct (m (next h)) eqn:E1, (m g) eqn:E2; try discriminate; apply mem_in in E1 || apply mem_in in E2.
    + rewrite <- (prev_next h) at 1. eapply (loop_tears moved (torn S) (next h)); eauto. rewrite prev_next; eauto.
    + rewrite (Hc _ _ E). eapply (loop_tears moved (torn S) g); eauto.
Qed.

(* A split refines the labels. *)
Lemma labels_are_refined : forall h g, h < size S -> g < size S -> (o h = o g <-> m h = m g /\ origin S h = origin S g).
Proof.
  intros h g Hh Hg. unfold o.
  pose proof (origin_in_range _ W h Hh). pose proof (origin_in_range _ W g Hg).
  destruct (m h) eqn:E1, (m g) eqn:E2.
  - apply mem_in in E1, E2. apply moved_at_v in E1, E2. destruct E1, E2. split; auto. split; congruence.
  - split; [lia|]. intros [E _]; discriminate.
  - split; [lia|]. intros [E _]; discriminate.
  - tauto.
Qed.

Definition after := Mesh (faces S) (link S) (fold_left tear moved (torn S)) o (1 + vertices S).

Theorem after_is_well_formed : well_formed after.
Proof.
  constructor; unfold after; simpl; auto.
  - intros h Hh. unfold o. destruct (m h); auto. pose proof (origin_in_range _ W h Hh). lia.
  - intros h g E. rewrite !loop_tears_what_is_separated, (torn_both_sides _ W _ _ E), (separated_symmetric _ _ E). auto.
  - intros h E. rewrite loop_tears_what_is_separated, (boundary_not_torn _ W _ E). unfold separated. rewrite E. auto.
  - intros h g E. rewrite loop_tears_what_is_separated. destruct (link_below _ _ E) as [Hh Hg].
    assert (next g < size S) by (apply next_below; auto).
    assert (next h < size S) by (apply next_below; auto).
    rewrite !labels_are_refined by auto. rewrite orb_false_iff, (pair_agrees _ W _ _ E). unfold separated. rewrite E.
    rewrite orb_false_iff. destruct (m h), (m (next g)), (m (next h)), (m g); simpl; intuition discriminate.
  - intros h g Hh Hg H. apply labels_are_refined in H; auto. apply (one_root _ W); tauto.
Qed.
End Split.

(* A split of a well-formed mesh is well-formed: I2 to I8. *)
Theorem split_keeps_well_formed : forall S v moves S', well_formed S -> split S v moves = Some S' -> well_formed S'.
Proof.
  intros S v moves S' W. unfold split.
  destruct (filter moves (corners_of S v)) as [|a l] eqn:E1; [discriminate|].
  destruct (filter (fun h => negb (moves h)) (corners_of S v)); [discriminate|].
  intros H. injection H as <-. apply (after_is_well_formed S W v (a :: l)).
  intros h Hh. rewrite <- E1 in Hh. apply filter_In in Hh. apply (walk_lists_exactly_the_corners S W v). tauto.
Qed.
(* A split is refused if a side would be empty, and only then. *)
Theorem split_refuses_an_empty_side : forall S v moves, well_formed S ->
  (split S v moves = None <->
   (forall h, h < size S -> origin S h = v -> moves h = false) \/ (forall h, h < size S -> origin S h = v -> moves h = true)).
Proof.
  intros S v moves W. unfold split. destruct (walk_lists_exactly_the_corners S W v) as [_ Hall].
  destruct (filter moves (corners_of S v)) as [|a l] eqn:E1.
  - split; auto. intros _. left. intros h Hh Ho. destruct (moves h) eqn:E; auto.
    exfalso. assert (In h []); [|auto]. rewrite <- E1. apply filter_In. rewrite Hall. auto.
  - assert (Ha : In a (a :: l)) by (left; auto). rewrite <- E1 in Ha. apply filter_In in Ha. rewrite Hall in Ha.
    destruct (filter (fun h => negb (moves h)) (corners_of S v)) as [|b k] eqn:E2.
    + split; auto. intros _. right. intros h Hh Ho. destruct (moves h) eqn:E; auto.
      exfalso. assert (In h []); [|auto]. rewrite <- E2. apply filter_In. rewrite Hall, E. auto.
    + assert (Hb : In b (b :: k)) by (left; auto). rewrite <- E2 in Hb. apply filter_In in Hb. rewrite Hall in Hb.
      split; [discriminate|]. intros [H|H]; exfalso.
      * rewrite H in Ha; intuition discriminate.
      * rewrite H in Hb; intuition discriminate.
Qed.
Lemma split_leaves_both_sides : forall S v moves S', well_formed S -> split S v moves = Some S' ->
  exists a b, (a < size S /\ origin S a = v /\ moves a = true) /\ (b < size S /\ origin S b = v /\ moves b = false).
Proof.
  intros S v moves S' W. unfold split. destruct (walk_lists_exactly_the_corners S W v) as [_ Hall].
  destruct (filter moves (corners_of S v)) as [|a l] eqn:E1; [discriminate|].
  destruct (filter (fun h => negb (moves h)) (corners_of S v)) as [|b k] eqn:E2; [discriminate|]. intros _. exists a, b.
  assert (Ha : In a (a :: l)) by (left; auto). rewrite <- E1, filter_In, Hall in Ha.
  assert (Hb : In b (b :: k)) by (left; auto). rewrite <- E2, filter_In, Hall, negb_true_iff in Hb. tauto.
Qed.
(* I15, I16: links stay; what moved is at the new vertex, what stayed at the old one, every other corner where it was. *)
Theorem split_changes_nothing_else : forall S v moves S', well_formed S -> split S v moves = Some S' ->
  faces S' = faces S /\ link S' = link S /\ vertices S' = 1 + vertices S /\
  (forall h, h < size S -> origin S' h = if (origin S h =? v) && moves h then vertices S else origin S h) /\
  (forall h, h < size S -> (In h (corners_of S' (vertices S)) <-> origin S h = v /\ moves h = true)) /\
  (forall h, h < size S -> (In h (corners_of S' v) <-> origin S h = v /\ moves h = false)).
Proof.
  intros S v moves S' W E. pose proof (split_keeps_well_formed _ _ _ _ W E) as W'.
  assert (Hv : v < vertices S).
  { destruct (split_leaves_both_sides _ _ _ _ W E) as (a & _ & (Ha & <- & _) & _). apply (origin_in_range _ W); auto. }
  destruct (walk_lists_exactly_the_corners S W v) as [_ Hall]. unfold split in E.
  destruct (filter moves (corners_of S v)) as [|a l] eqn:E1; [discriminate|].
  destruct (filter (fun h => negb (moves h)) (corners_of S v)); [discriminate|].
  injection E as E'. assert (Ho : forall h, h < size S ->
    origin S' h = if (origin S h =? v) && moves h then vertices S else origin S h).
  { intros h Hh. subst S'. change (origin _ h) with (if mem h (a :: l) then vertices S else origin S h) at 1.
    replace (mem h (a :: l)) with ((origin S h =? v) && moves h); auto.
    apply eq_true_iff_eq. rewrite mem_in, <- E1, filter_In, Hall, andb_true_iff, Nat.eqb_eq. tauto. }
  assert (Hs : size S' = size S) by (subst S'; auto).
  assert (Hwalk : forall w h, h < size S -> (In h (corners_of S' w) <-> origin S' h = w)).
  { intros w h Hh. destruct (walk_lists_exactly_the_corners S' W' w) as [_ ->]. rewrite Hs. tauto. }
  do 3 (split; [subst S'; auto|]). split; auto. split; intros h Hh; rewrite Hwalk, Ho by auto;
    pose proof (origin_in_range _ W h Hh); destruct (origin S h =? v) eqn:Ev, (moves h); simpl;
    apply Nat.eqb_eq in Ev || apply Nat.eqb_neq in Ev; intuition (lia || discriminate).
Qed.
(* I16: besides what was torn, a link is torn if at one of its ends one corner moved and the other stayed. *)
Theorem split_tears_between_the_sides : forall S v moves S' h g, well_formed S -> split S v moves = Some S' ->
  let moved x := (origin S x =? v) && moves x in link S h = Some g ->
  torn S' h = torn S h || xorb (moved h) (moved (next g)) || xorb (moved (next h)) (moved g).
Proof.
  intros S v moves S' h g W E moved El. pose proof (split_keeps_well_formed _ _ _ _ W E) as W'.
  destruct (split_changes_nothing_else _ _ _ _ W E) as (_ & El' & _ & Ho & _).
  destruct (link_in_range _ _ (is_manifold S W) _ _ El) as [Hh Hg].
  assert (Hn : next h < size S /\ next g < size S) by (split; apply next_below; auto).
  assert (Hends : forall x y, x < size S -> y < size S ->
    (origin S' x = origin S' y <-> origin S x = origin S y /\ moved x = moved y)).
  { intros x y Hx Hy. rewrite !Ho by auto. fold (moved x) (moved y).
    pose proof (origin_in_range _ W x Hx). pose proof (origin_in_range _ W y Hy).
    destruct (moved x) eqn:Ex, (moved y) eqn:Ey; try (split; [lia|intros [_ H1]; discriminate]); [|tauto].
    unfold moved in Ex, Ey. rewrite andb_true_iff, Nat.eqb_eq in Ex, Ey. intuition congruence. }
  pose proof (pair_agrees _ W _ _ El) as Ha. rewrite <- El' in El. pose proof (pair_agrees _ W' _ _ El) as Ha'.
  rewrite !Hends in Ha' by tauto.
  apply eq_iff_eq_true. rewrite <- !not_false_iff_true, !orb_false_iff.
  destruct (moved h), (moved (next h)), (moved g), (moved (next g)); simpl; intuition discriminate.
Qed.

Lemma repeats_none : forall l, repeats l = false <-> NoDup l.
Proof.
  induction l as [|f l IH]; simpl; [split; auto using NoDup_nil|].
  rewrite orb_false_iff, IH, <- not_true_iff_false, mem_in, NoDup_cons_iff. tauto.
Qed.
Lemma face_is : forall h f, face h = f <-> h = 3 * f \/ h = 3 * f + 1 \/ h = 3 * f + 2.
Proof.
  intros h f. unfold face. pose proof (Nat.div_mod h 3 ltac:(lia)). pose proof (Nat.mod_upper_bound h 3 ltac:(lia)).
  split; [lia|]. intros E. symmetry. apply (Nat.div_unique h 3 f (h - 3 * f)); lia.
Qed.
Lemma at_vertex_spec : forall S v f, at_vertex S v f = true <-> exists h, h < size S /\ origin S h = v /\ face h = f.
Proof.
  intros S v f. unfold at_vertex, size. rewrite andb_true_iff, Nat.ltb_lt, existsb_exists. split.
  - intros [Hf (h & Hh & E)]. apply Nat.eqb_eq in E. exists h. rewrite face_is. simpl in Hh. intuition lia.
  - intros (h & Hh & E & Ef). apply face_is in Ef. split; [lia|]. exists h. rewrite E, Nat.eqb_refl. simpl. intuition lia.
Qed.
(* `split::vertex` is refused if a face is not one of the vertex, or is listed twice, or if a side would be empty; and
   only then. Otherwise it is a split, by which the faces of the list move. *)
Theorem split_vertex_refuses : forall S v faces, well_formed S ->
  (split_vertex S v faces = None <->
   (exists f, In f faces /\ forall h, h < size S -> origin S h = v -> face h <> f) \/ ~ NoDup faces \/
   faces = [] \/ (forall h, h < size S -> origin S h = v -> In (face h) faces)).
Proof.
  intros S v faces W. unfold split_vertex. destruct (existsb _ _) eqn:Ef; simpl.
  { split; auto. intros _. left. apply existsb_exists in Ef. destruct Ef as (f & Hf & E). exists f. split; auto.
    intros h Hh Eh Efh. apply negb_true_iff in E. rewrite (proj2 (at_vertex_spec S v f)) in E; [discriminate|eauto]. }
  assert (Hat : forall f, In f faces -> exists h, h < size S /\ origin S h = v /\ face h = f).
  { intros f Hf. apply at_vertex_spec. destruct (at_vertex S v f) eqn:E; auto. exfalso.
    rewrite <- not_true_iff_false, existsb_exists in Ef. apply Ef. exists f. rewrite E. auto. }
  destruct (repeats faces) eqn:Er.
  { split; auto. intros _. right. left. intros H. apply repeats_none in H. congruence. }
  apply repeats_none in Er. rewrite split_refuses_an_empty_side by auto. setoid_rewrite mem_in.
  split; [intros [H|H]|intros [(f & Hf & H)|[H|[->|H]]]]; auto; try tauto.
  - right. right. left. destruct faces as [|f l]; auto. destruct (Hat f) as (h & Hh & Eh & Efh); [left; auto|].
    specialize (H h Hh Eh). rewrite <- not_true_iff_false, mem_in, Efh in H. simpl in H. tauto.
  - destruct (Hat f Hf) as (h & Hh & Eh & Efh). destruct (H h); auto.
Qed.
Lemma split_vertex_is_a_split : forall S v faces S', split_vertex S v faces = Some S' ->
  split S v (fun h => mem (face h) faces) = Some S'.
Proof. unfold split_vertex. intros S v faces S'. destruct (_ || _); [discriminate|auto]. Qed.
