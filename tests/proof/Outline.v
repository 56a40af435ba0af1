(* What an insertion keeps: all of each face that it does not divide, and the outline of each that it divides.

   Every half-edge is one half-edge still or, on the edge that gets the vertex, two in a row. These *pieces* run as it
   ran, are linked as it was, and torn if and only if it was. The pieces of the three half-edges of a face are the outline
   of its children: whatever else its children have is paired among them. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split Cone Insert.
Import ListNotations.

Definition runs S x a b := origin S x = a /\ origin S (next x) = b.

(* `on_edge` are the half-edges that get a vertex, and `in_face` the faces that are divided. `parent` is the face of which
   a face of the new mesh is a part. *)
Record keeps_outlines (S S' : mesh) (on_edge in_face : nat -> Prop) (pieces : nat -> list nat) (parent : nat -> nat) :
  Prop := {
  (* The half-edges of a face that is not divided have the numbers that they had, *)
  stays_itself : forall h, h < size S -> ~ in_face (face h) -> pieces h = [h];
  (* and every half-edge has the ends that it had, with a new vertex between them or none, *)
  is_one : forall h, h < size S -> ~ on_edge h ->
    exists x, pieces h = [x] /\ runs S' x (origin S h) (origin S (next h));
  is_two : forall h, h < size S -> on_edge h -> exists x y v, pieces h = [x; y] /\ vertices S <= v /\
    runs S' x (origin S h) v /\ runs S' y v (origin S (next h));
  (* the link that it had, *)
  is_linked : forall h, h < size S -> map (link S') (pieces h) = match link S h with
    | Some g => map Some (rev (pieces g)) | None => map (fun _ => None) (pieces h) end;
  (* and the mark. *)
  is_torn : forall h x, h < size S -> In x (pieces h) -> torn S' x = torn S h;
  (* The pieces of a half-edge are its own, and belong to children of its face. *)
  is_of_one : forall h g x, h < size S -> g < size S -> In x (pieces h) -> In x (pieces g) -> h = g;
  is_of_parent : forall h x, h < size S -> In x (pieces h) -> x < size S' /\ parent (face x) = face h;
  (* One child has the number of its face. *)
  keeps_its_number : forall f, f < faces S -> parent f = f;
  (* Everything else is inside a face that is divided, and paired there. *)
  rest_is_paired : forall x, x < size S' -> (forall h, h < size S -> ~ In x (pieces h)) ->
    in_face (parent (face x)) /\ exists y, pair S' x = Some y /\ parent (face y) = parent (face x) }.

Section Cone.
Variables (S : mesh) (c : cone) (first : nat).
Hypothesis W : well_formed S.
Hypothesis O : outlined S c first.
Let S' := insert S c.
Let M := is_manifold S W.
Let On w := In w (outline c).
Let valid := valid S c.

Definition is_gap p := divided c p /\ ~ On p.
Definition parts p := if existsb (fun w => face w =? face p) (outline c) && negb (mem p (outline c))
  then [Back (prev p); Forth (next p)] else [kept c p].
Definition pieces p := map (number c) (parts p).
Definition parent f := match find (fun w => face (forth c w) =? f) (outline c) with None => f | Some w => face w end.
Definition part_face k := match k with Rest p | Edge p | Back p | Forth p => face p end.

(* A half-edge is kept, or it is taken out and two of the face take its place. *)
Lemma parts_are : forall p, p < size S -> (~ is_gap p /\ valid (kept c p) /\ parts p = [kept c p]) \/
  (is_gap p /\ On (prev p) /\ On (next p) /\ parts p = [Back (prev p); Forth (next p)]).
Proof.
  intros p Hp. assert (Hd : existsb (fun w => face w =? face p) (outline c) = true <-> divided c p).
  { rewrite existsb_exists. unfold divided. setoid_rewrite Nat.eqb_eq. tauto. }
  unfold parts, is_gap, kept, valid. pose proof (mem_in p (outline c)) as Hm. fold (On p) in Hm.
  destruct (existsb _ _), (mem p _); simpl; [left|right|left|left].
  - repeat split; try tauto. constructor. tauto.
  - assert (H : divided c p /\ ~ On p) by (intuition discriminate).
    destruct (off_outline S c first O p) as [H1 H2]; tauto.
  - repeat split; try tauto. constructor. tauto.
  - assert (H : ~ divided c p) by (intuition discriminate). repeat split; try tauto. constructor; auto.
Qed.
Lemma kept_face : forall p, part_face (kept c p) = face p.
Proof. intros p. unfold kept. destruct (mem p _); auto. Qed.
Lemma parts_valid : forall p k, p < size S -> In k (parts p) -> valid k /\ part_face k = face p.
Proof.
  intros p k Hp. destruct (parts_are p Hp) as [(_ & Hv & ->)|(_ & H1 & H2 & ->)]; simpl.
  - intros [<-|[]]. auto using kept_face.
  - intros [<-|[<-|[]]]; simpl; rewrite ?face_prev, ?face_next; split; auto; constructor; auto.
Qed.
Definition whole k := match k with Rest p | Edge p => p | Back w => next w | Forth w => prev w end.
Lemma whole_is : forall p k, In k (parts p) -> whole k = p.
Proof.
  intros p k. unfold parts, kept. destruct (_ && _); [|destruct (mem p _)]; simpl; intros Hk;
    repeat destruct Hk as [<-|Hk]; try contradiction; simpl; auto using next_prev, prev_next.
Qed.
Lemma parent_is : forall k, valid k -> parent (face (number c k)) = part_face k.
Proof.
  intros k [p Hp Hd|w Hw|w Hw|w Hw]; unfold parent; simpl; rewrite ?face_next, ?face_prev;
    [|erewrite found by eauto; auto ..].
  destruct (find _ _) as [u|] eqn:E; auto. apply find_some in E. destruct E as [Hu E]. apply Nat.eqb_eq in E.
  destruct (rest_is_nowhere_else S c first O p u Hp Hd Hu E).
Qed.
Lemma number_runs : forall k, valid k -> runs S' (number c k) (part_origin S c k) (part_origin S c (next_part k)).
Proof.
  intros k Hk. unfold runs, S'. rewrite next_number, !(origin_number S c first O); auto. apply next_valid; auto.
Qed.
(* Two triangles side by side in one face are paired. *)
Lemma inner_pair : forall w u, On w -> On u -> face w = face u -> next w = u ->
  pair S' (number c (Back w)) = Some (number c (Forth u)) /\ pair S' (number c (Forth u)) = Some (number c (Back w)).
Proof.
  intros w u Hw Hu Ef E. assert (Es : succ c w = Some u).
  { apply (follows_if_it_can S c first O); auto. rewrite E. apply rt_refl. }
  assert (Ec : cut c w = false).
  { apply (cut_if_apart S c first O w u Es). rewrite E. split; auto.
    unfold new_vertex. rewrite (one_point_in_a_face S c first O w u); auto. }
  assert (Ep := proj1 (precedes S c first O w u) Es). unfold pair, S'.
  rewrite !(torn_number S c first O), !(link_number S c first O) by (constructor; auto). simpl. rewrite Ep, Es, Ec. auto.
Qed.

Variables (on_edge in_face : nat -> Prop).
Hypothesis edge_is_gap : forall p, p < size S -> (on_edge p <-> is_gap p).
Hypothesis face_is_divided : forall p, in_face (face p) <-> divided c p.

Theorem cone_keeps_outlines : keeps_outlines S S' on_edge in_face pieces parent.
Proof.
  assert (Hlink : forall k, valid k -> link S' (number c k) = option_map (number c) (part_link S c k)).
  { exact (link_number S c first O). }
  constructor.
  - intros h Hh Hn. unfold pieces. rewrite face_is_divided in Hn.
    destruct (parts_are h Hh) as [(_ & _ & ->)|([H _] & _)]; [|contradiction]. unfold kept.
    destruct (mem h _) eqn:E; auto. apply mem_in in E. destruct Hn. exists h. auto.
  - intros h Hh Hn. rewrite edge_is_gap in Hn by auto. unfold pieces.
    destruct (parts_are h Hh) as [(_ & Hv & ->)|(H & _)]; [|contradiction]. exists (number c (kept c h)). split; auto.
    destruct (kept_origins S c h) as [<- <-]. apply number_runs; auto.
  - intros h Hh Hn. rewrite edge_is_gap in Hn by auto. unfold pieces.
    destruct (parts_are h Hh) as [(H & _)|(_ & Hp & Hn' & ->)]; [contradiction|].
    exists (number c (Back (prev h))), (number c (Forth (next h))), (new_vertex S c (next h)). split; auto.
    pose proof (number_runs _ (valid_back S c _ Hp)) as R1. pose proof (number_runs _ (valid_forth S c _ Hn')) as R2.
    simpl in R1, R2. rewrite next_prev in R1. unfold new_vertex in *.
    rewrite (one_point_in_a_face S c first O (prev h) (next h)) in R1; auto; [|rewrite face_next, face_prev; auto].
    split; auto. destruct (second c _); lia.
  - intros h Hh. unfold pieces. rewrite map_map.
    destruct (parts_are h Hh) as [(Hn & Hv & E)|([Hd Hn] & Hp & Hx & E)]; rewrite E.
    + cbn [map]. rewrite Hlink, part_link_kept by auto. destruct (link S h) as [g|] eqn:El; auto. simpl.
      destruct (link_in_range _ _ M _ _ El) as [_ Hg]. destruct (parts_are g Hg) as [(_ & _ & ->)|([Hd Hng] & _)]; auto.
      pose proof (link_is_involution _ _ M _ _ El) as El'.
      destruct (gap S c first O g h Hd Hng El') as (H1 & H2 & _). destruct Hn. split; auto.
    + cbn [map]. rewrite !Hlink by (constructor; auto). simpl. destruct (link S h) as [g|] eqn:El.
      * destruct (gap S c first O h g Hd Hn El) as (H1 & H2 & Es & _). destruct (link_in_range _ _ M _ _ El) as [_ Hg].
        pose proof (link_is_involution _ _ M _ _ El) as El'.
        destruct (gap S c first O g h H1 H2 El') as (_ & _ & Es' & _).
        apply (precedes S c first O) in Es. rewrite Es, Es'.
        destruct (parts_are g Hg) as [(Hno & _)|(_ & _ & _ & ->)]; auto. destruct Hno. split; auto.
      * destruct (gap_on_boundary S c first O h Hd Hn El) as [-> ->]. auto.
  - intros h x Hh Hx. unfold pieces in Hx. apply in_map_iff in Hx. destruct Hx as (k & <- & Hk).
    destruct (parts_valid h k Hh Hk) as [Hv _]. unfold S'. rewrite (torn_number S c first O) by auto.
    destruct (parts_are h Hh) as [(_ & _ & E)|([Hd Hn] & _ & _ & E)]; rewrite E in Hk.
    + destruct Hk as [<-|[]]. apply kept_torn.
    + destruct (link S h) as [g|] eqn:El.
      * destruct (gap S c first O h g Hd Hn El) as (H1 & H2 & Es & Ec).
        pose proof (link_is_involution _ _ M _ _ El) as El'.
        destruct (gap S c first O g h H1 H2 El') as (_ & _ & Es' & Ec').
        apply (precedes S c first O) in Es. rewrite (torn_both_sides S W h g El) in *.
        destruct Hk as [<-|[<-|[]]]; simpl; rewrite ?Es; auto.
      * destruct (gap_on_boundary S c first O h Hd Hn El) as [E1 E2]. rewrite (boundary_not_torn S W h El).
        destruct Hk as [<-|[<-|[]]]; simpl; rewrite ?E2; auto. apply (cut_follows S c first O); auto.
  - intros h g x Hh Hg Hx Hy. unfold pieces in *. apply in_map_iff in Hx, Hy.
    destruct Hx as (k & <- & Hk), Hy as (j & E & Hj).
    apply (number_injective S c first O) in E; [subst j|apply (parts_valid g j Hg Hj)|apply (parts_valid h k Hh Hk)].
    rewrite <- (whole_is _ _ Hk). apply whole_is; auto.
  - intros h x Hh Hx. unfold pieces in Hx. apply in_map_iff in Hx. destruct Hx as (k & <- & Hk).
    destruct (parts_valid h k Hh Hk) as [Hv <-]. split; [|apply parent_is; auto]. apply (number_below S c first O); auto.
  - intros f Hf. unfold parent. destruct (find _ _) as [w|] eqn:E; auto.
    apply find_some in E. destruct E as [Hw E]. apply Nat.eqb_eq in E.
    destruct (triangle_in_place S c first O w Hw) as [_ H]. rewrite <- E, H; auto. apply face_below. lia.
  - intros x Hx Hno. destruct (numbered S c first O x Hx) as (k & Hk & ->).
    assert (Hpart : forall p, p < size S -> ~ In k (parts p)).
    { intros p Hp Hin. apply (Hno p Hp). apply in_map; auto. }
    assert (Hgap : forall w, On w -> forall p, face w = face p -> p < size S -> ~ On p ->
      parts p = [Back (prev p); Forth (next p)]).
    { intros w Hw p Ef Hp Hn. destruct (parts_are p Hp) as [(H & _)|(_ & _ & _ & E)]; auto.
      destruct H. split; auto. exists w; auto. }
    destruct Hk as [p Hp Hd|w Hw|w Hw|w Hw].
    + destruct (Hpart p Hp). destruct (parts_are p Hp) as [(_ & _ & ->)|([H _] & _)]; [|contradiction].
      left. apply (kept_itself S c (Rest p) p); auto. constructor; auto.
    + pose proof (on_mesh S c first O w Hw) as Hs. destruct (Hpart w Hs).
      destruct (parts_are w Hs) as [(_ & _ & ->)|([_ H] & _)]; [|contradiction].
      left. apply (kept_itself S c (Edge w) w); auto. constructor; auto.
    + pose proof (on_mesh S c first O w Hw) as Hs. pose proof (next_below w _ Hs) as Hn.
      destruct (in_dec Nat.eq_dec (next w) (outline c)) as [H|H].
      * destruct (inner_pair w (next w)) as [E _]; auto using eq_sym, face_next.
        rewrite parent_is by (constructor; auto). split; [apply face_is_divided; exists w; auto|].
        eexists. split; [exact E|]. rewrite !parent_is by (constructor; auto). apply face_next.
      * destruct (Hpart (next w) Hn). rewrite (Hgap w Hw); auto using eq_sym, face_next. left. rewrite prev_next. auto.
    + pose proof (on_mesh S c first O w Hw) as Hs. pose proof (prev_below w _ Hs) as Hn.
      destruct (in_dec Nat.eq_dec (prev w) (outline c)) as [H|H].
      * destruct (inner_pair (prev w) w) as [_ E]; auto using face_prev, next_prev.
        rewrite parent_is by (constructor; auto). split; [apply face_is_divided; exists w; auto|].
        eexists. split; [exact E|]. rewrite !parent_is by (constructor; auto). apply face_prev.
      * destruct (Hpart (prev w) Hn). rewrite (Hgap w Hw); auto using eq_sym, face_prev.
        right. left. rewrite next_prev. auto.
Qed.
End Cone.

(* A vertex in a face, which is put on no edge. *)
Theorem insert_in_face_keeps_outlines : forall S f S', well_formed S -> insert_in_face S f = Some S' ->
  exists pieces parent, keeps_outlines S S' (fun _ => False) (eq f) pieces parent.
Proof.
  intros S f S' W. unfold insert_in_face. destruct (f <? faces S) eqn:Hf; [|discriminate]. intros E. injection E as <-.
  apply Nat.ltb_lt in Hf. do 2 eexists. eapply cone_keeps_outlines; eauto using face_outlined.
  - intros p _. unfold is_gap. rewrite divided_face, on_face by auto. tauto.
  - intros p. rewrite divided_face by auto. split; auto.
Qed.
(* A vertex on an edge: on the half-edge and on the one that it is linked to, in the faces of both. *)
Theorem insert_on_edge_keeps_outlines : forall S h S', well_formed S -> insert_on_edge S h = Some S' ->
  let on_edge k := k = h \/ link S h = Some k in
  exists pieces parent, keeps_outlines S S' on_edge (fun f => exists k, on_edge k /\ face k = f) pieces parent.
Proof.
  intros S h S' W. unfold insert_on_edge. destruct (h <? size S) eqn:Hh; [|discriminate]. intros E. injection E as <-.
  apply Nat.ltb_lt in Hh. destruct (link S h) as [g|] eqn:Eg; do 2 eexists.
  - destruct (off S h g W Eg) as [Oh Og]. eapply cone_keeps_outlines; eauto using edge_outlined; intros p.
    + intros _. unfold is_gap. rewrite divided_two. split.
      * intros [->|Ep]; [auto|]. injection Ep as ->. auto.
      * intros [[Ef|Ef] Hn]; symmetry in Ef; apply of_one_face in Ef; destruct Ef as [->|[->| ->]]; auto;
          destruct Hn; simpl; auto.
    + rewrite divided_two. split; [intros (k & [->|Ek] & <-); auto; injection Ek as ->; auto|].
      intros [Ef|Ef]; symmetry in Ef; eauto.
  - eapply cone_keeps_outlines; eauto using boundary_outlined; intros p.
    + intros _. unfold is_gap. rewrite divided_boundary. split.
      * intros [->|Ep]; [|discriminate]. split; auto.
        simpl. pose proof (next_differs h). pose proof (prev_differs h). tauto.
      * intros [Ef Hn]. symmetry in Ef. apply of_one_face in Ef.
        destruct Ef as [->|[->| ->]]; auto; destruct Hn; simpl; auto.
    + rewrite divided_boundary. split; [intros (k & [->|Ek] & <-); auto; discriminate|]. intros Ef. exists h. auto.
Qed.
