(* Judges what the Rust code did, by the functions that were extracted from the proof.

   Standard input has the lines that tests/proof.rs writes:

     script                          the states that follow are those of a new mesh
     build accepted VERTICES FACES … triangles, which were built or
     build refused VERTICES FACES …  refused
     split OLD NEW CORNER …          corners went from one vertex to a new one
     merge KEPT GONE                 two vertices became one
     refused split V FACE …          a split that was refused
     refused merge V W               a merge that was refused, since the roots differ or the vertices are one
     insert face F                   a vertex was put in a face
     insert edge H                   a vertex was put on an edge, or on both sides of a torn one
     insert                          several were; the next state is judged by the checker alone
     state FACES VERTICES …          origins, links (-1: none), torn marks, and each vertex's walk, with its length

   Each state must be accepted by the checker and be the one that the model has, each walk must be the model's, in its
   order, and each refusal must be one of the model. *)
open Model

let states = ref 0 and edits = ref 0 and unjudged = ref 0 and refusals = ref 0 and walks = ref 0
let builds = ref 0 and accepted = ref 0 and largest = ref 0 and faults = ref 0 and line = ref 0

let fault what =
  incr faults;
  if !faults <= 10 then Printf.printf "line %d: %s\n%!" !line what

(* A state on arrays. *)
let mesh_of faces vertices origin link torn =
  let inside none a h = if h >= 0 && h < Array.length a then a.(h) else none in
  { faces; vertices; origin = inside 0 origin; link = inside None link; torn = inside false torn }

(* The state that an operation of the model gives, which is closures upon closures, on arrays again. *)
let frozen m =
  let n = 3 * m.faces in
  mesh_of m.faces m.vertices (Array.init n m.origin) (Array.init n m.link) (Array.init n m.torn)

let agrees a b =
  let rec from h =
    h < 0 || (a.origin h = b.origin h && a.link h = b.link h && a.torn h = b.torn h && from (h - 1)) in
  a.faces = b.faces && a.vertices = b.vertices && from ((3 * a.faces) - 1)

(* Who has the same root, by a flood from each corner. It needs no trust: a wrong witness makes the checker refuse. *)
let witness m =
  let n = 3 * m.faces in
  let root = Array.make n (-1) and turns = Array.make n 0 and between = Hashtbl.create (2 * n) in
  let root_of = Array.make (max 1 m.vertices) 0 in
  for first = 0 to n - 1 do
    let queue = Queue.create () in
    let reach h steps =
      if h >= 0 && h < n && root.(h) < 0 then (root.(h) <- first; turns.(h) <- steps; Queue.add h queue) in
    reach first 0;
    while not (Queue.is_empty queue) do
      let h = Queue.take queue in
      let reach_from = function Some g -> reach g (turns.(h) + 1) | None -> () in
      reach_from (m.link (prev h));
      reach_from (Option.map next (m.link h))
    done
  done;
  let get none a i = if i >= 0 && i < Array.length a then a.(i) else none in
  for h = 0 to n - 1 do
    Hashtbl.replace between (root.(h), root.(next h)) h;
    let v = m.origin h in
    if v >= 0 && v < m.vertices then root_of.(v) <- root.(h)
  done;
  { root = get (-1) root; turns = get 0 turns; edge_from = (fun a b -> Hashtbl.find_opt between (a, b));
    root_of = get (-1) root_of }

let judge_state old words =
  let at = ref 1 in
  let number () = incr at; int_of_string words.(!at - 1) in
  let faces = number () in
  let vertices = number () in
  let numbers = Array.init (9 * faces) (fun _ -> number ()) in
  let part k = Array.sub numbers (3 * faces * k) (3 * faces) in
  let link = Array.map (fun g -> if g < 0 then None else Some g) (part 1) in
  let m = mesh_of faces vertices (part 0) link (Array.map (( = ) 1) (part 2)) in
  incr states;
  largest := max !largest faces;
  if not (check m (witness m)) then fault "the state is not well-formed";
  Option.iter (fun old -> if not (agrees old m) then fault "the state is not the model's") old;
  for v = 0 to vertices - 1 do
    let length = number () in
    let walk = List.init length (fun _ -> number ()) in
    incr walks;
    if walk <> corners_of m v then fault (Printf.sprintf "the walk round v%d is not the model's" v)
  done;
  m

(* What a line makes of the model's state; none where the model has no say. *)
let judge model words =
  let int i = int_of_string words.(i) in
  let list first = List.init (Array.length words - first) (fun i -> int (first + i)) in
  let edit name result =
    incr edits;
    if model = None then incr unjudged;
    match Option.map result model with
    | Some None -> fault ("the model refuses a " ^ name); None
    | Some (Some m) -> Some (frozen m)
    | None -> None in
  let refusal name result =
    Option.iter (fun m -> incr refusals; if result m <> None then fault ("the model has no reason to refuse a " ^ name)) model;
    model in
  match words.(0), if Array.length words > 1 then words.(1) else "" with
  | "script", _ -> None
  | "build", outcome ->
    incr builds;
    let origin = Array.init (3 * int 3) (fun h -> int (h + 4)) in
    let built = build (int 2) (int 3) (fun h -> if h < Array.length origin then origin.(h) else 0) in
    if (outcome = "accepted") <> (built <> None) then fault ("the model disagrees: " ^ outcome);
    Option.map (fun m -> incr accepted; frozen m) built
  | "state", _ -> Some (judge_state model words)
  | "split", _ ->
    let old = int 1 and corners = list 3 in
    let are_its_own m = List.for_all (fun h -> m.origin h = old) corners in
    let split m = if are_its_own m then split_vertex m old (List.map (fun h -> h / 3) corners) else None in
    let after = edit "split" split in
    Option.iter (fun m -> if m.vertices <> int 2 + 1 then fault "the new vertex is not the last one") after;
    after
  | "merge", _ -> edit "merge" (fun m -> merge m (int 1) (int 2))
  | "insert", "face" -> edit "insertion in a face" (fun m -> insert_in_face m (int 2))
  | "insert", "edge" -> edit "insertion on an edge" (fun m -> insert_on_edge m (int 2))
  | "insert", _ -> incr edits; incr unjudged; None
  | "refused", "split" -> refusal "split" (fun m -> split_vertex m (int 2) (list 3))
  | "refused", "merge" -> refusal "merge" (fun m -> merge m (int 2) (int 3))
  | other, _ -> fault ("no line begins with " ^ other); model

let () =
  let model = ref None in
  (try
     while true do
       let words = Array.of_list (String.split_on_char ' ' (input_line stdin)) in
       incr line;
       model := judge !model words
     done
   with End_of_file -> ());
  Printf.printf "%d of %d lists of triangles accepted, " !accepted !builds;
  Printf.printf "%d states of up to %d faces, %d walks, %d edits (%d of them not by the model), %d refusals: %d faults\n"
    !states !largest !walks !edits !unjudged !refusals !faults;
  exit (if !faults = 0 && !states > 0 then 0 else 1)
