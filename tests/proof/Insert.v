(* A vertex in a face, and a vertex on an edge: inside, on the boundary, or torn.

   The numbers of faces and half-edges are those that src/insert.rs gives for a plan of one point. A torn edge gets two
   vertices, one on each side, and its two parts are ghost pairs; with a point on one side alone the walk could not cross
   it. A plan of several points is not in the model. *)
Require Import Arith List Lia Bool Relations.
Require Import Walk State Split Cone.
Import ListNotations.

Local Arguments Nat.mul : simpl never.
Local Arguments Nat.add : simpl never.
Local Arguments Nat.modulo : simpl never.
Local Arguments Nat.ltb : simpl never.
Local Arguments Nat.eqb : simpl never.

(* All three half-edges of the face are the outline. *)
Definition face_cone S f : cone := Cone
  [3 * f; 3 * f + 1; 3 * f + 2]
  (fun w => if face w =? f then Some (next w) else None)
  (fun w => if face w =? f then Some (prev w) else None)
  (fun w => match w mod 3 with 0 => 3 * f | 1 => 3 * faces S | _ => 3 * (1 + faces S) end)
  (2 + faces S) (fun _ => false) (fun _ => false).
Definition insert_in_face S f : option mesh :=
  if f <? faces S then Some (insert S (face_cone S f)) else None.

(* The half-edges Forth of the two triangles of a face that is divided at its half-edge x; one of the triangles gets
   the new number. *)
Definition forth_at x new w :=
  if w =? next x then (if x mod 3 =? 0 then 3 * face x else 3 * new)
  else 2 + (if x mod 3 =? 0 then 3 * new else 3 * face x).
(* On the boundary the outline is open: what is left of one face. *)
Definition boundary_cone S h : cone := Cone
  [next h; prev h]
  (fun w => if w =? next h then Some (prev h) else None)
  (fun w => if w =? prev h then Some (next h) else None)
  (forth_at h (faces S)) (1 + faces S) (fun _ => false) (fun _ => false).
(* Inside, it goes round both faces of the edge. The face with the lower number gets the lower new number. *)
Definition edge_cone S h g : cone := Cone
  [next h; prev h; next g; prev g]
  (fun w => if w =? next h then Some (prev h) else if w =? prev h then Some (next g)
            else if w =? next g then Some (prev g) else if w =? prev g then Some (next h) else None)
  (fun w => if w =? prev h then Some (next h) else if w =? next g then Some (prev h)
            else if w =? prev g then Some (next g) else if w =? next h then Some (prev g) else None)
  (fun w => let later := face g <? face h in
            if face w =? face h then forth_at h (if later then 1 + faces S else faces S) w
            else forth_at g (if later then faces S else 1 + faces S) w)
  (2 + faces S)
  (fun w => torn S h && ((w =? prev h) || (w =? prev g)))
  (fun w => torn S h && negb (face w =? face h)).
Definition insert_on_edge S h : option mesh :=
  if h <? size S then
    Some (insert S (match link S h with None => boundary_cone S h | Some g => edge_cone S h g end))
  else None.

Lemma face_of : forall k r, r < 3 -> face (3 * k + r) = k.
Proof. intros k r H. unfold face. symmetry. apply (Nat.div_unique _ 3 k r); lia. Qed.
Lemma face_0 : forall k, face (3 * k) = k.
Proof. intros k. rewrite <- (Nat.add_0_r (3 * k)). apply face_of. lia. Qed.
Lemma face_2 : forall k, face (2 + 3 * k) = k.
Proof. intros k. rewrite Nat.add_comm. apply face_of. lia. Qed.
Lemma face_below : forall x n, x < 3 * n <-> face x < n.
Proof.
  intros x n. unfold face. split; intros H.
  - apply Nat.div_lt_upper_bound; lia.
  - pose proof (Nat.div_mod x 3 ltac:(lia)). pose proof (Nat.mod_upper_bound x 3 ltac:(lia)). nia.
Qed.
Lemma of_face : forall w, w = 3 * face w \/ w = 3 * face w + 1 \/ w = 3 * face w + 2.
Proof.
  intros w. destruct (corner_form w) as (q & H). assert (E : face w = q); [|lia].
  destruct H as [->|[->| ->]]; rewrite ?face_0, ?face_of; lia.
Qed.

Section InFace.
Variables (S : mesh) (f : nat).
Hypothesis W : well_formed S.
Hypothesis Hf : f < faces S.
Let M := is_manifold S W.
Let c := face_cone S f.
Lemma on_face : forall w, In w (outline c) <-> face w = f.
Proof.
  intros w. unfold c, face_cone. cbn [outline In]. split.
  - intros [<-|[<-|[<-|[]]]]; rewrite ?face_0, ?face_of; lia.
  - intros E. destruct (of_face w) as [H|[H|H]]; rewrite E in H; auto.
Qed.
Lemma divided_face : forall p, divided c p <-> face p = f.
Proof.
  intros p. unfold divided. split.
  - intros (w & Hw & E). apply on_face in Hw. congruence.
  - intros E. exists p. rewrite on_face. auto.
Qed.
Lemma roots_of_face : forall w u, face w = f -> face u = f -> same_root (link S) w u -> w = u.
Proof.
  intros w u Hw Hu E. assert (Hs : w < size S /\ u < size S) by (unfold size; rewrite !face_below; lia).
  destruct (of_one_face w u) as [->|[->| ->]]; [congruence|auto| |].
  - apply (three_roots _ _ M) in E; tauto.
  - apply joined_sym in E. rewrite <- (next_prev w) in E at 2. apply (three_roots _ _ M) in E; tauto.
Qed.
Lemma face_forth_face : forall w,
  face (forth c w) = match w mod 3 with 0 => f | 1 => faces S | _ => 1 + faces S end.
Proof. intros w. simpl. destruct (w mod 3) as [|[|]]; apply face_0. Qed.
Lemma face_outlined : outlined S c (3 * f).
Proof.
  constructor; try (intros w H; apply on_face in H).
  - unfold size. rewrite face_below. lia.
  - intros p Hd Hn. exfalso. apply Hn, on_face, divided_face; auto.
  - intros w u E. simpl in E. destruct (face w =? f) eqn:Ef; [|discriminate]. injection E as <-.
    apply Nat.eqb_eq in Ef. rewrite !on_face, face_next. repeat split; auto. apply rt_refl.
  - intros w u. simpl. split; intros E.
    + destruct (face w =? f) eqn:Ef; [|discriminate]. injection E as <-. rewrite face_next, Ef, prev_next. auto.
    + destruct (face u =? f) eqn:Ef; [|discriminate]. injection E as <-. rewrite face_prev, Ef, next_prev. auto.
  - intros w u H Hu E. apply on_face in H, Hu. apply roots_of_face in E; rewrite ?face_next; auto.
    simpl. rewrite H, Nat.eqb_refl. congruence.
  - intros w u H Hu. apply on_face in H, Hu. apply roots_of_face; auto.
  - intros w u H Hu E. apply on_face in H, Hu. apply roots_of_face in E; rewrite ?face_next; auto.
    rewrite <- (prev_next w), E. apply prev_next.
  - intros w u E1 E2. simpl in *. destruct (face w =? f); [|discriminate]. destruct (face u =? f); [|discriminate].
    assert (E : next (next w) = w) by congruence. rewrite next_next in E. apply (prev_differs w); auto.
  - intros p q Hd Hn. exfalso. apply Hn, on_face, divided_face; auto.
  - intros p Hd Hn. exfalso. apply Hn, on_face, divided_face; auto.
  - split; [apply on_face, face_0|]. intros w H. apply on_face in H.
    assert (Hs : forall x, face x = f -> joined (succ c) x (next x)).
    { intros x Hx. apply rt_step. left. simpl. rewrite Hx, Nat.eqb_refl. auto. }
    destruct (of_one_face (3 * f) w) as [->|[->| ->]]; [rewrite face_0; auto|apply rt_refl| |].
    + apply Hs, face_0.
    + rewrite <- next_next. eapply joined_trans; apply Hs; rewrite ?face_next; apply face_0.
  - intros w u H Hu. apply on_face in H, Hu. rewrite !face_forth_face.
    destruct (of_face w) as [E1|[E1|E1]], (of_face u) as [E2|[E2|E2]]; rewrite E1, E2, H, Hu;
      rewrite ?mod_form0, ?mod_form by lia; intros E; lia.
  - unfold size. rewrite !face_below, face_forth_face. simpl faces_then. destruct (w mod 3) as [|[|]]; split; auto; lia.
  - intros x Hx. rewrite face_below in Hx. simpl faces_then in Hx.
    destruct (Nat.eq_dec (face x) f) as [E|E].
    { left. exists (3 * f). rewrite on_face, face_forth_face, face_0, mod_form0. auto. }
    destruct (le_lt_dec (faces S) (face x)) as [H|H].
    + left. destruct (Nat.eq_dec (face x) (faces S)) as [E1|E1].
      * exists (3 * f + 1). rewrite on_face, face_forth_face, face_of, mod_form by lia. auto.
      * exists (3 * f + 2). rewrite on_face, face_forth_face, face_of, mod_form by lia. split; auto. lia.
    + right. rewrite divided_face. split; auto. unfold size. rewrite face_below. auto.
  - simpl. lia.
  - auto.
  - auto.
  - intros w u E. simpl in E. destruct (face w =? f); [|discriminate]. injection E as <-. simpl. tauto.
Qed.
End InFace.

Section OnBoundary.
Variables (S : mesh) (h : nat).
Hypothesis W : well_formed S.
Hypothesis Hh : h < size S.
Hypothesis E0 : link S h = None.
Let M := is_manifold S W.
Let c := boundary_cone S h.
Lemma divided_boundary : forall p, divided c p <-> face p = face h.
Proof.
  intros p. unfold divided. simpl. split.
  - intros (w & [<-|[<-|[]]] & E); rewrite ?face_next, ?face_prev in E; auto.
  - intros E. exists (next h). rewrite face_next. auto.
Qed.
Lemma face_forth_at : forall x new w, face (forth_at x new w) =
  if w =? next x then (if x mod 3 =? 0 then face x else new) else (if x mod 3 =? 0 then new else face x).
Proof. intros. unfold forth_at. destruct (w =? next x), (x mod 3 =? 0); rewrite ?face_0, ?face_2; auto. Qed.
Lemma next_not_prev : (prev h =? next h) = false.
Proof. apply Nat.eqb_neq. intros E. apply (next_is_not_prev h). auto. Qed.
Lemma three_of : forall x, x < size S -> ~ same_root (link S) x (next x) /\ ~ same_root (link S) (next x) (prev x) /\
  ~ same_root (link S) (prev x) x.
Proof.
  intros x Hx. repeat split; [apply (three_roots _ _ M); auto| |].
  - rewrite <- next_next. apply (three_roots _ _ M). apply next_below; auto.
  - rewrite <- (next_prev x) at 2. apply (three_roots _ _ M). apply prev_below; auto.
Qed.
Lemma boundary_outlined : outlined S c (next h).
Proof.
  destruct (three_of h Hh) as (R1 & R2 & R3). pose proof next_not_prev as Hn.
  assert (Hface : face h < faces S) by (apply face_below; auto).
  constructor.
  - intros w [<-|[<-|[]]]; [apply next_below|apply prev_below]; auto.
  - intros p Hd H. apply divided_boundary in Hd. destruct (of_one_face h p) as [->|[->| ->]]; simpl in *; tauto || auto.
  - intros w u E. simpl in E. destruct (w =? next h) eqn:Ew; [|discriminate]. injection E as <-.
    apply Nat.eqb_eq in Ew. subst w. simpl. rewrite next_next. repeat split; auto. apply rt_refl.
  - intros w u. simpl. destruct (w =? next h) eqn:E1, (u =? prev h) eqn:E2;
      rewrite ?Nat.eqb_eq, ?Nat.eqb_neq in *; split; intros E; congruence.
  - intros w u Hw Hu E. simpl in *.
    destruct Hw as [<-|[<-|[]]], Hu as [<-|[<-|[]]]; rewrite ?next_next, ?next_prev, ?Nat.eqb_refl, ?Hn in *; auto; exfalso; auto.
    + apply R2, joined_sym; auto. + apply R3, joined_sym; auto.
  - intros w u Hw Hu E. simpl in *. destruct Hw as [<-|[<-|[]]], Hu as [<-|[<-|[]]]; auto; exfalso; auto.
    apply R2, joined_sym; auto.
  - intros w u Hw Hu E. simpl in *.
    destruct Hw as [<-|[<-|[]]], Hu as [<-|[<-|[]]]; rewrite ?next_next, ?next_prev in *; auto; exfalso; auto.
    apply R3, joined_sym; auto.
  - intros w u E1 E2. simpl in *. destruct (w =? next h) eqn:Ew; [|discriminate]. injection E1 as <-.
    rewrite Hn in E2. discriminate.
  - intros p q Hd H E. apply divided_boundary in Hd. destruct (of_one_face h p) as [->|[->| ->]]; simpl in *; auto;
      [congruence|tauto|tauto].
  - intros p Hd H E. apply divided_boundary in Hd.
    destruct (of_one_face h p) as [->|[->| ->]]; simpl in *; auto; [|tauto|tauto]. rewrite Hn, Nat.eqb_sym, Hn. auto.
  - split; [simpl; auto|]. intros w [<-|[<-|[]]]; [apply rt_refl|]. apply rt_step. left. simpl.
    rewrite Nat.eqb_refl. auto.
  - intros w u Hw Hu E. simpl in *. rewrite !face_forth_at in E.
    destruct Hw as [<-|[<-|[]]], Hu as [<-|[<-|[]]]; auto; rewrite ?Nat.eqb_refl, ?Hn in E; destruct (h mod 3 =? 0); lia.
  - intros w Hw. assert (E : face w = face h) by (apply divided_boundary; exists w; auto).
    rewrite E, !face_below. simpl faces_then. simpl forth. unfold size.
    rewrite face_below, face_forth_at. destruct (w =? next h), (h mod 3 =? 0); split; auto; lia.
  - intros x Hx. rewrite face_below in Hx. simpl faces_then in Hx. rewrite divided_boundary.
    assert (Htwo : exists w, In w (outline c) /\ face (forth c w) = face h).
    { exists (if h mod 3 =? 0 then next h else prev h). simpl. rewrite face_forth_at.
      destruct (h mod 3 =? 0); rewrite ?Nat.eqb_refl, ?Hn; auto. }
    assert (Hnew : exists w, In w (outline c) /\ face (forth c w) = faces S).
    { exists (if h mod 3 =? 0 then prev h else next h). simpl. rewrite face_forth_at.
      destruct (h mod 3 =? 0); rewrite ?Nat.eqb_refl, ?Hn; auto. }
    destruct (Nat.eq_dec (face x) (face h)) as [E|E]; [left; rewrite E; auto|].
    destruct (Nat.eq_dec (face x) (faces S)) as [E'|E']; [left; rewrite E'; auto|].
    right. split; auto. unfold size. rewrite face_below. lia.
  - simpl. lia.
  - auto.
  - auto.
  - intros w u E. simpl in E. destruct (w =? next h) eqn:Ew; [|discriminate]. injection E as <-.
    apply Nat.eqb_eq in Ew. subst w. simpl. rewrite next_next. tauto.
Qed.
End OnBoundary.

Section Inside.
Variables (S : mesh) (h g : nat).
Hypothesis W : well_formed S.
Hypothesis E0 : link S h = Some g.
Let M := is_manifold S W.
Let c := edge_cone S h g.
Let Eg : link S g = Some h := link_is_involution _ _ M _ _ E0.
Lemma both_below : h < size S /\ g < size S.
Proof. exact (link_in_range _ _ M _ _ E0). Qed.
Lemma faces_apart : face h <> face g.
Proof. exact (link_leaves_face _ _ M _ _ E0). Qed.
Lemma ends_meet : same_root (link S) h (next g) /\ same_root (link S) (next h) g.
Proof.
  split; [apply joined_sym|]; apply rt_step; left; rewrite prev_next; auto.
Qed.
Lemma divided_two : forall p, divided c p <-> face p = face h \/ face p = face g.
Proof.
  intros p. unfold divided. simpl. split.
  - intros (w & [<-|[<-|[<-|[<-|[]]]]] & E); rewrite ?face_next, ?face_prev in E; auto.
  - intros [E|E]; [exists (next h)|exists (next g)]; rewrite face_next; auto.
Qed.
(* The four half-edges of the outline are four, and no two begin at one root. *)
Lemma four : next h <> prev h /\ next g <> prev g /\ next h <> next g /\ next h <> prev g /\
  prev h <> next g /\ prev h <> prev g /\ h <> next g /\ h <> prev g /\ g <> next h /\ g <> prev h.
Proof.
  pose proof faces_apart as H. repeat split; try apply next_is_not_prev; intros E; apply H;
    apply (f_equal face) in E; rewrite ?face_next, ?face_prev in E; auto.
Qed.
Lemma starts_apart : forall w u, In w (outline c) -> In u (outline c) -> same_root (link S) w u -> w = u.
Proof.
  destruct both_below as [Hh Hg]. destruct ends_meet as [Ma Mb].
  destruct (three_of S W h Hh) as (R1 & R2 & R3). destruct (three_of S W g Hg) as (Q1 & Q2 & Q3).
  assert (N1 : ~ same_root (link S) (next h) (next g)).
  { intros E. apply R1. eapply joined_trans; [exact Ma|]. apply joined_sym; auto. }
  assert (N2 : ~ same_root (link S) (next h) (prev g)).
  { intros E. apply Q3. eapply joined_trans; [apply joined_sym; exact E|]. auto. }
  assert (N3 : ~ same_root (link S) (prev h) (next g)).
  { intros E. apply R3. eapply joined_trans; [exact E|]. apply joined_sym; auto. }
  assert (N4 : ~ same_root (link S) (prev h) (prev g)).
  { intros E. apply (root_faces_differ _ _ M h (next g)); auto; [apply next_below; auto| |];
      rewrite ?prev_next, ?next_next; auto. }
  intros w u Hw Hu E. simpl in Hw, Hu.
  destruct Hw as [<-|[<-|[<-|[<-|[]]]]], Hu as [<-|[<-|[<-|[<-|[]]]]]; auto; exfalso; auto;
    apply joined_sym in E; auto.
Qed.
Ltac equalities := repeat match goal with
  | |- context [?x =? ?y] => destruct (Nat.eqb_spec x y)
  | H : context [?x =? ?y] |- _ => destruct (Nat.eqb_spec x y) end.
Lemma succ_is : succ c (next h) = Some (prev h) /\ succ c (prev h) = Some (next g) /\
  succ c (next g) = Some (prev g) /\ succ c (prev g) = Some (next h).
Proof. destruct four as (D1 & D2 & D3 & D4 & D5 & D6 & _). simpl. repeat split; equalities; congruence. Qed.
Lemma succ_on : forall w u, succ c w = Some u ->
  (w = next h /\ u = prev h) \/ (w = prev h /\ u = next g) \/ (w = next g /\ u = prev g) \/ (w = prev g /\ u = next h).
Proof. intros w u E. simpl in E. equalities; try discriminate; injection E as <-; auto. Qed.
Lemma follows_inside : forall w u, succ c w = Some u ->
  In w (outline c) /\ In u (outline c) /\ same_root (link S) (next w) u.
Proof.
  destruct ends_meet as [Ma Mb]. intros w u E. apply succ_on in E. simpl.
  destruct E as [[-> ->]|[[-> ->]|[[-> ->]|[-> ->]]]]; rewrite ?next_next, ?next_prev;
    repeat split; auto; try apply rt_refl. apply joined_sym; auto.
Qed.
Lemma all_followed : forall w, In w (outline c) -> exists u, succ c w = Some u.
Proof.
  destruct succ_is as (S1 & S2 & S3 & S4). intros w Hw. simpl in Hw.
  destruct Hw as [<-|[<-|[<-|[<-|[]]]]]; eauto.
Qed.
Lemma precedes_inside : forall w u, succ c w = Some u <-> pred c u = Some w.
Proof.
  destruct four as (D1 & D2 & D3 & D4 & D5 & D6 & _). intros w u. simpl. split; intros E; equalities; congruence.
Qed.
Let new_h := if face g <? face h then 1 + faces S else faces S.
Let new_g := if face g <? face h then faces S else 1 + faces S.
Lemma face_forth_inside :
  face (forth c (next h)) = (if h mod 3 =? 0 then face h else new_h) /\
  face (forth c (prev h)) = (if h mod 3 =? 0 then new_h else face h) /\
  face (forth c (next g)) = (if g mod 3 =? 0 then face g else new_g) /\
  face (forth c (prev g)) = (if g mod 3 =? 0 then new_g else face g).
Proof.
  assert (Hf : (face g =? face h) = false) by (apply Nat.eqb_neq; intros E; apply faces_apart; auto).
  pose proof (next_not_prev h) as Hh. pose proof (next_not_prev g) as Hg.
  simpl. rewrite ?face_next, ?face_prev, ?Nat.eqb_refl, ?Hf, !face_forth_at, ?Nat.eqb_refl, ?Hh, ?Hg. auto.
Qed.
Lemma off : ~ In h (outline c) /\ ~ In g (outline c).
Proof.
  destruct four as (_ & _ & _ & _ & _ & _ & D7 & D8 & D9 & D10). pose proof (next_differs h). pose proof (next_differs g).
  pose proof (prev_differs h). pose proof (prev_differs g). simpl. intuition congruence.
Qed.
Lemma edge_outlined : outlined S c (next h).
Proof.
  destruct both_below as [Hh Hg]. pose proof faces_apart as Hf. pose proof ends_meet as [Ma Mb].
  destruct succ_is as (S1 & S2 & S3 & S4).
  assert (Fh : face h < faces S) by (apply face_below; auto).
  assert (Fg : face g < faces S) by (apply face_below; auto).
  destruct face_forth_inside as (T1 & T2 & T3 & T4).
  assert (Hnn : faces S <= new_h < 2 + faces S /\ faces S <= new_g < 2 + faces S /\ new_h + new_g = 1 + 2 * faces S).
  { unfold new_h, new_g. destruct (face g <? face h); lia. }
  constructor.
  - intros w Hw. simpl in Hw. destruct Hw as [<-|[<-|[<-|[<-|[]]]]]; try apply next_below; try apply prev_below; auto.
  - intros p Hd Hn. apply divided_two in Hd. destruct Hd as [E|E]; symmetry in E; apply of_one_face in E;
      destruct E as [->|[->| ->]]; simpl in *; tauto || auto 6.
  - exact follows_inside.
  - exact precedes_inside.
  - intros w u Hw Hu E. destruct (all_followed w Hw) as (v & Ev). destruct (follows_inside _ _ Ev) as (_ & Hv & E').
    rewrite Ev. f_equal. apply starts_apart; auto. eapply joined_trans; [apply joined_sym; exact E'|auto].
  - exact starts_apart.
  - intros w u Hw Hu E. destruct (all_followed w Hw) as (v & Ev), (all_followed u Hu) as (y & Ey).
    destruct (follows_inside _ _ Ev) as (_ & Hv & E1). destruct (follows_inside _ _ Ey) as (_ & Hy & E2).
    assert (v = y). { apply starts_apart; auto. eapply joined_trans; [apply joined_sym; exact E1|].
      eapply joined_trans; [exact E|auto]. }
    subst y. apply precedes_inside in Ev, Ey. congruence.
  - destruct four as (D1 & D2 & D3 & D4 & D5 & D6 & _). intros w u E1 E2. apply succ_on in E1, E2.
    destruct E1 as [[-> ->]|[[-> ->]|[[-> ->]|[-> ->]]]], E2 as [[X Y]|[[X Y]|[[X Y]|[X Y]]]]; congruence.
  - intros p q Hd Hn E. apply divided_two in Hd. destruct Hd as [E'|E']; symmetry in E'; apply of_one_face in E';
      destruct E' as [->|[->| ->]]; try (exfalso; apply Hn; simpl; auto 6; fail).
    + assert (q = g) by congruence. subst q. rewrite divided_two, (torn_both_sides S W g h Eg). simpl cut.
      rewrite Nat.eqb_refl, orb_true_r, andb_true_r. repeat split; auto. apply off.
    + assert (q = h) by congruence. subst q. rewrite divided_two. simpl cut.
      rewrite Nat.eqb_refl, andb_true_r. repeat split; auto. apply off.
  - intros p Hd Hn E. apply divided_two in Hd. destruct Hd as [E'|E']; symmetry in E'; apply of_one_face in E';
      destruct E' as [->|[->| ->]]; try (exfalso; apply Hn; simpl; auto 6; fail); congruence.
  - split; [simpl; auto|]. intros w Hw. simpl in Hw.
    assert (J : forall x y, succ c x = Some y -> joined (succ c) x y) by (intros; apply rt_step; left; auto).
    pose proof (joined_trans _ _ _ _ (J _ _ S1) (J _ _ S2)) as J2. pose proof (joined_trans _ _ _ _ J2 (J _ _ S3)) as J3.
    destruct Hw as [<-|[<-|[<-|[<-|[]]]]]; [apply rt_refl|apply J; exact S1|exact J2|exact J3].
  - intros w u Hw Hu E. simpl in Hw, Hu.
    destruct Hw as [<-|[<-|[<-|[<-|[]]]]], Hu as [<-|[<-|[<-|[<-|[]]]]]; auto; exfalso;
      rewrite ?T1, ?T2, ?T3, ?T4 in E; destruct (h mod 3 =? 0), (g mod 3 =? 0); lia.
  - intros w Hw. unfold size. rewrite !face_below. simpl faces_then. simpl in Hw.
    destruct Hw as [<-|[<-|[<-|[<-|[]]]]]; rewrite ?T1, ?T2, ?T3, ?T4, ?face_next, ?face_prev;
      destruct (h mod 3 =? 0), (g mod 3 =? 0); split; auto; lia.
  - intros x Hx. rewrite face_below in Hx. simpl faces_then in Hx. rewrite divided_two.
    assert (Hof : (exists w, In w (outline c) /\ face (forth c w) = face h) /\
                  (exists w, In w (outline c) /\ face (forth c w) = face g)).
    { split; [exists (if h mod 3 =? 0 then next h else prev h)|exists (if g mod 3 =? 0 then next g else prev g)];
        [destruct (h mod 3 =? 0)|destruct (g mod 3 =? 0)]; rewrite ?T1, ?T2, ?T3, ?T4; simpl; auto 6. }
    assert (Hnew : (exists w, In w (outline c) /\ face (forth c w) = new_h) /\
                   (exists w, In w (outline c) /\ face (forth c w) = new_g)).
    { split; [exists (if h mod 3 =? 0 then prev h else next h)|exists (if g mod 3 =? 0 then prev g else next g)];
        [destruct (h mod 3 =? 0)|destruct (g mod 3 =? 0)]; rewrite ?T1, ?T2, ?T3, ?T4; simpl; auto 6. }
    destruct Hof as [Hof1 Hof2], Hnew as [Hnew1 Hnew2].
    destruct (Nat.eq_dec (face x) (face h)) as [E|E]; [left; rewrite E; auto|].
    destruct (Nat.eq_dec (face x) (face g)) as [E'|E']; [left; rewrite E'; auto|].
    destruct (le_lt_dec (faces S) (face x)) as [H|H].
    + left. destruct (Nat.eq_dec (face x) new_h) as [E1|E1]; [rewrite E1; auto|].
      replace (face x) with new_g by lia. auto.
    + right. split; [unfold size; rewrite face_below; auto|tauto].
  - simpl. lia.
  - intros w u _ _ E. simpl. rewrite E. auto.
  - intros w E. unfold c, edge_cone. cbn [cut]. destruct (Nat.eqb_spec w (prev h)) as [->|]; [congruence|].
    destruct (Nat.eqb_spec w (prev g)) as [->|]; [congruence|]. apply andb_false_r.
  - clear T1 T2 T3 T4 Hnn. destruct (torn S h) eqn:Et.
    + assert (Ends : origin S h = origin S (next g) -> origin S (next h) = origin S g -> False).
      { intros H1 H2. pose proof (pair_agrees S W _ _ E0) as [_ H]. rewrite H in Et; [discriminate|auto]. }
      destruct four as (D1 & D2 & D3 & D4 & D5 & D6 & _).
      intros w u E. apply succ_on in E. unfold new_vertex. simpl. rewrite Et. simpl.
      destruct E as [[-> ->]|[[-> ->]|[[-> ->]|[-> ->]]]]; rewrite ?face_next, ?face_prev, ?next_next, ?next_prev;
        equalities; try congruence; simpl; split; intros; auto; try discriminate; lia.
    + destruct (pair_agrees S W _ _ E0) as [H _]. destruct (H Et) as [H1 H2].
      intros w u E. apply succ_on in E. unfold new_vertex. simpl. rewrite Et. simpl.
      destruct E as [[-> ->]|[[-> ->]|[[-> ->]|[-> ->]]]]; rewrite ?next_next, ?next_prev; split; auto.
Qed.
End Inside.

(* A vertex in a face, or on any edge, of a well-formed mesh: the mesh is well-formed again, I2 to I8. *)
Theorem insert_in_face_keeps_well_formed : forall S f S', well_formed S -> insert_in_face S f = Some S' -> well_formed S'.
Proof.
  intros S f S' W. unfold insert_in_face. destruct (f <? faces S) eqn:E; [|discriminate]. intros H. injection H as <-.
  apply Nat.ltb_lt in E. eapply cone_keeps_well_formed; eauto. apply face_outlined; auto.
Qed.
Theorem insert_on_edge_keeps_well_formed : forall S h S', well_formed S -> insert_on_edge S h = Some S' -> well_formed S'.
Proof.
  intros S h S' W. unfold insert_on_edge. destruct (h <? size S) eqn:E; [|discriminate]. intros H. injection H as <-.
  apply Nat.ltb_lt in E. destruct (link S h) as [g|] eqn:Eg.
  - eapply cone_keeps_well_formed; eauto. apply edge_outlined; auto.
  - eapply cone_keeps_well_formed; eauto. apply boundary_outlined; auto.
Qed.
