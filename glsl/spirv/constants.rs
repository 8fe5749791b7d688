// Written by build.rs from the shaders: constants of theirs.
pub mod along {
    pub const ALONG_BEFORE: u32 = 2;
    pub const ALONG_BEHIND: u32 = 4;
    pub const ALONG_INSIDE: u32 = 1;
}
pub mod ambient_find {
    pub const FADES: f32 = 0.75;
    pub const HORIZON_STEPS: i32 = 4;
    pub const MOST_HEIGHT: f32 = 0.2;
    pub const PI: f32 = 3.14159265;
    pub const PIXELS: i32 = 8;
    pub const SLICES: i32 = 2;
}
pub mod ambient_write {
    pub const OFF: f32 = 0.1;
    pub const STRENGTH: f32 = 0.75;
}
pub mod behind {
    pub const CELL_PX: f32 = 32.0;
    pub const DEPTH_ROUNDING: f32 = 1e-5;
    pub const MOST_CELLS: u32 = 8;
    pub const OUTSIDE_CELLS: u32 = 8;
    pub const PUSH_SLACK: f32 = 2.0;
}
pub mod blister {
    pub const PEEL_ENTRIES: u32 = 1;
    pub const PEEL_EXITS: u32 = 2;
    pub const PEEL_UNLOCKS: u32 = 4;
}
pub mod border {
    pub const NO_BORDER: f32 = -3.0e38;
}
pub mod border_around {
    pub const AROUND: u32 = 9;
    pub const BORDER_POINTS: u32 = 16;
    pub const NOBODY: u32 = 15;
    pub const OWN: u32 = 4;
    pub const ROWS_OF_FIRST: u32 = 0x50c84f2a;
    pub const ROWS_OF_LAST: u32 = 0x6b1e73d9;
    pub const SLIVER: u32 = 9;
}
pub mod border_cells {
    pub const BAND_ROUNDING: f32 = 1e-4;
    pub const BORDER_BANDS: u32 = 4;
    pub const BORDER_COLUMNS: f32 = 128.0;
}
pub mod border_find {
    pub const FACET: u32 = 0xfffffffe;
    pub const GROUP: u32 = 64;
    pub const OTHER: u32 = 0xffffffff;
    pub const POINTS: u32 = 16;
    pub const ROWS: i32 = 16;
}
pub mod border_followed {
    pub const FOLLOWED_GROUP: u32 = 64;
    pub const FOLLOWED_SHOWN: u32 = 16;
}
pub mod border_mesh {
    pub const LEADS_NOWHERE_PX: f32 = 1.5;
}
pub mod border_mix {
    pub const CLOSE_PX: f32 = 0.02;
    pub const MOST_SHEETS: u32 = 4;
    pub const POINT_STEPS: u32 = 8;
}
pub mod border_pixel {
    pub const JUMP_OF_CLIMB: f32 = 0.5;
    pub const JUMP_PX: f32 = 2.0;
    pub const NO_SLIVER: u32 = 0xffffffff;
}
pub mod border_reach {
    pub const ASIDE: f32 = 0.015625;
    pub const MOST_FROM_MIDDLE: f32 = 1.5;
    pub const REMAINDER_PX: f32 = 0.125;
}
pub mod border_sliver {
    pub const FAR_ROWS: u32 = 7;
}
pub mod border_vertex {
    pub const MAX_BEND: f32 = 0.25;
}
pub mod bound {
    pub const DEPTH_SHARE: f32 = 1.5;
}
pub mod boundary_operands {
    pub const FRAGMENT_LEAVES: u32 = 0x80000000;
    pub const FRAGMENT_OPERAND: u32 = 0x0fffffff;
    pub const FRAGMENT_PATCH: u32 = 0x20000000;
    pub const FRAGMENT_SKIRT: u32 = 0x40000000;
    pub const FRAGMENT_WITHIN: u32 = 0x10000000;
    pub const NO_PLANE: u32 = 0xffffffff;
}
pub mod cone {
    pub const EYE_ROUNDING: f32 = 1e-5;
}
pub mod coverage {
    pub const CHORDS: u32 = 8;
    pub const MOST_CELLS: u32 = 128;
    pub const MOST_FACES: u32 = 4;
    pub const SAME_SHEET_PX: f32 = 4.0;
    pub const TOUCHES: f32 = 1e-5;
}
pub mod depth_pyramid {
    pub const SMALL_PICTURE: u32 = 131072;
    pub const SMALL_SQUARE: u32 = 2;
    pub const SQUARE: u32 = 4;
}
pub mod dispatch_arguments {
    pub const GROUP: u32 = 128;
    pub const MOST_NUMBERED: u32 = 0x80000000;
    pub const SCAN_BLOCK: u32 = 1024;
}
pub mod edge_covered {
    pub const COVERS_OWN_OFF: f32 = 7.0;
    pub const COVERS_PX: f32 = 0.01;
}
pub mod edge_divide {
    pub const EDGE_HALVES: u32 = 0xffffffff;
    pub const EDGE_HALVINGS: u32 = 22;
    pub const EDGE_MOST_CHORDS: u32 = 16;
    pub const EDGE_MOST_POINTS: u32 = 16;
    pub const EDGE_OUTSIDE: u32 = 0;
    pub const EDGE_TOLERANCE_PX: f32 = 0.09;
}
pub mod edge_line {
    pub const DASH: f32 = 8.0;
    pub const GAP: f32 = 6.0;
    pub const SEED_ROUNDED: f32 = 1e-4;
    pub const TRIMS_TELL_PX: f32 = 1.0;
    pub const TURN_SHEET_PX: f32 = 2.0;
}
pub mod edge_seen {
    pub const ARRIVED_PX: f32 = 0.05;
    pub const POINT_ROUNDING: f32 = 1e-6;
}
pub mod edge_show {
    pub const EDGE_COVERS: f32 = 0.1;
}
pub mod edges {
    pub const CHANGE_SHARES: f32 = 65535.0;
    pub const CHANGE_STYLE: u32 = 16;
    pub const EDGE_BOLD: u32 = 2;
    pub const EDGE_FULL: u32 = 0;
    pub const EDGE_MOST_SEEDS: u32 = 3;
    pub const EDGE_NEAR: u32 = 4;
    pub const EDGE_SEEDS: u32 = 4;
    pub const EDGE_STYLE: u32 = 3;
    pub const EDGE_THIN: u32 = 1;
    pub const EDGE_TURNS: u32 = 64;
    pub const EDGE_UNDRAWN: u32 = 8;
    pub const FOLD_NUMBER: u32 = 0xffffffff;
    pub const LINES_FOLDS: u32 = 8;
    pub const LINES_SHARP: u32 = 1;
    pub const LINES_SMOOTH: u32 = 2;
    pub const LINES_SMOOTH_FULL: u32 = 4;
    pub const LINE_BOLD: u32 = 3;
    pub const LINE_CHORD: u32 = 0xffffff;
    pub const LINE_COVERAGE: u32 = 24;
    pub const LINE_FULL: u32 = 1;
    pub const LINE_NONE: u32 = 0;
    pub const LINE_SEEN: u32 = 0x80000000;
    pub const LINE_SOLID: u32 = 0xfffffe;
    pub const LINE_STEPS: f32 = 127.0;
    pub const LINE_THIN: u32 = 2;
    pub const MOST_HALF_PX: f32 = 100.0;
    pub const OWN_TRIANGLE: u32 = 0x80000000;
    pub const SEED_END: f32 = 0.015625;
    pub const SEED_REACH_PX: f32 = 1.5;
    pub const SEED_TEXELS: u32 = 2;
    pub const SOLID_NUMBER: u32 = 0xfffffffe;
}
pub mod exact {
    pub const ARC_LAST: u32 = 8;
    pub const ARC_UP: u32 = 4;
    pub const AT_HIGH: u32 = 2;
    pub const AT_LOW: u32 = 1;
    pub const CELL_SPLIT: u32 = 0x80000000;
    pub const FAR: f32 = 1e30;
    pub const MARGIN: f32 = 0.25;
}
pub mod face_point {
    pub const ROUNDED: f32 = 1e-5;
}
pub mod face_sheet {
    pub const FACE_AT_PX: f32 = 0.05;
    pub const FACE_PLANES: u32 = 3;
    pub const FACING: f32 = 0.35;
    pub const SHARE_ROUNDING: f32 = 1e-3;
}
pub mod factor {
    pub const SPARE: f32 = 0.125;
    pub const UP: f32 = 1.00001;
}
pub mod fold {
    pub const FOLD_BESIDE: f32 = 0.25;
    pub const FOLD_BESIDE_WINDOW: f32 = 8.0;
    pub const FOLD_FAR_OUT_PX: f32 = 64.0;
    pub const FOLD_FAR_PX: f32 = 16.0;
    pub const FOLD_HOPS: u32 = 8;
    pub const FOLD_NARROW_PX: f32 = 1.0;
    pub const FOLD_SHEET_PX: f32 = 0.25;
    pub const FOLD_STEPS: u32 = 12;
}
pub mod fold_beside {
    pub const FOLD_REACH_PX: f32 = 1.5;
}
pub mod fold_list {
    pub const FOLD_COLUMNS: i32 = 62;
    pub const FOLD_ROWS: i32 = 16;
    pub const SAME_PLACE: f32 = 0.05;
}
pub mod fold_near {
    pub const NEAR_OFF_PX: f32 = 0.25;
}
pub mod gap_candidate {
    pub const ABSENT: u32 = 0;
    pub const FROM_BESIDE: u32 = 0;
    pub const FROM_BEYOND: u32 = 1;
    pub const FROM_FOLD: u32 = 2;
    pub const NEAR: u32 = 1;
    pub const PRESENT: u32 = 2;
}
pub mod gap_decide {
    pub const SAME_DEPTH: f32 = 1e-6;
}
pub mod gap_find {
    pub const GROUP: u32 = 64;
    pub const LANES: i32 = 64;
    pub const ROWS: i32 = 30;
}
pub mod gap_gather {
    pub const ACROSS: f32 = 0.2;
    pub const BAND_PX: u32 = 4;
}
pub mod gap_radius {
    pub const APOTHEM: f32 = 0.92387953;
    pub const CORNER: f32 = 1.06680402;
    pub const DIAGONAL: f32 = 0.70710678;
    pub const DIRECTION_COUNT: u32 = 8;
    pub const GAP_SLACK: f32 = 1.25;
    pub const SQUARE: f32 = 0.8;
}
pub mod gap_surface {
    pub const RADIUS_OF_INSIDE: u32 = 1;
    pub const RADIUS_OF_OUTSIDE: u32 = 2;
}
pub mod joints {
    pub const JOINS_AFTER: u32 = 2;
    pub const JOINS_BEFORE: u32 = 1;
}
pub mod layer_words {
    pub const HIGH_BITS: u32 = 8;
    pub const LOW_BITS: u32 = 24;
    pub const UV_BITS: u32 = 16;
}
pub mod line_list {
    pub const CHORD_OFF_PX: f32 = 0.25;
    pub const FOUND_WORDS: u32 = 9;
    pub const LINE_GROUP: u32 = 64;
    pub const LINE_ITEM_WORDS: u32 = 2;
    pub const LINE_SEED: u32 = 24;
    pub const ROUNDED_PX: f32 = 0.0625;
    pub const STEP_FOUND: u32 = 2;
    pub const STEP_LOOK: u32 = 1;
    pub const STEP_TEST: u32 = 0;
}
pub mod mesh_walk {
    pub const MOST_CROSSED: u32 = 32;
    pub const NO_TRIANGLE: u32 = 0xffffffff;
    pub const WALK_GONE: u32 = 1;
    pub const WALK_MET: u32 = 0;
    pub const WALK_TOO_FAR: u32 = 2;
    pub const WEIGHT_ROUNDING: f32 = 1e-5;
}
pub mod nearer {
    pub const MOST_SQUARES: u32 = 10;
}
pub mod on_pixel {
    pub const ON_PIXEL_PX: f32 = 0.05;
}
pub mod part_runs {
    pub const SCAN_BLOCK: u32 = 1024;
    pub const THREADS: u32 = 64;
}
pub mod parts {
    pub const LIST_ALL: u32 = 2;
    pub const LIST_APPEARING: u32 = 1;
    pub const LIST_FIRST: u32 = 0;
}
pub mod patch_normal {
    pub const FIRST_INWARDS: f32 = 1e-3;
    pub const MOST_INWARDS: f32 = 0.3;
}
pub mod patch_place {
    pub const BEYOND: f32 = 1e-4;
    pub const MAX_HOPS: u32 = 8;
}
pub mod push {
    pub const MAX_PUSH: f32 = 0.5;
}
pub mod refine {
    pub const CLOSE_ENOUGH: f32 = 5e-4;
    pub const DAMPED_STEPS: u32 = 8;
    pub const MAX_STEP: f32 = 0.25;
    pub const NEWTON_STEPS: u32 = 4;
}
pub mod resolved {
    pub const NO_SURFACE: u32 = 0xffffffff;
}
pub mod scene {
    pub const BORDER_U0: u32 = 1;
    pub const BORDER_U1: u32 = 2;
    pub const BORDER_V0: u32 = 4;
    pub const BORDER_V1: u32 = 8;
    pub const CORNER_LIST: u32 = 2;
    pub const CORNER_VERTICES: u32 = 6;
    pub const ENCODE_SUMMED: u32 = 2;
    pub const FACE_CLOSED_U: u32 = 1;
    pub const FACE_CLOSED_V: u32 = 2;
    pub const FACE_GOES_ON: u32 = 12;
    pub const FACE_MEETS_U: u32 = 64;
    pub const FACE_MEETS_V: u32 = 128;
    pub const FACE_OPERAND: u32 = 32;
    pub const FACE_POINTS: u32 = 8;
    pub const FACE_SAME_SENSE: u32 = 4;
    pub const FACE_SOLID: u32 = 8;
    pub const FACE_TRIMMED: u32 = 16;
    pub const FAILED_BLOCK_LEAVES: u32 = 32;
    pub const FAILED_DRAWS: u32 = 2;
    pub const FAILED_EDGE_CHORDS: u32 = 1024;
    pub const FAILED_FOLLOWED_POINTS: u32 = 2048;
    pub const FAILED_FRAGMENTS: u32 = 128;
    pub const FAILED_GAP_CANDIDATES: u32 = 16;
    pub const FAILED_INTERCEPTS: u32 = 8;
    pub const FAILED_LAYERS: u32 = 256;
    pub const FAILED_LINES: u32 = 4096;
    pub const FAILED_RAY_SEGMENTS: u32 = 512;
    pub const FAILED_ROWS: u32 = 4;
    pub const FAILED_SUB_PATCHES: u32 = 1;
    pub const FAILED_TILE_LEAVES: u32 = 64;
    pub const LINK_MOST_SIDES: u32 = 32;
    pub const MAX_FACTOR: u32 = 64;
    pub const MAX_ROWS: u32 = 65536;
    pub const MAX_SPLIT: u32 = 64;
    pub const MESH_NORMALS: u32 = 2;
    pub const MESH_SOLID: u32 = 1;
    pub const PLAIN_LIST: u32 = 0;
    pub const SIDE_BOUNDARY: u32 = 2;
    pub const SIDE_INSIDE: u32 = 1;
    pub const SIDE_OUTSIDE: u32 = 0;
    pub const STYLE_CLAY: u32 = 1;
    pub const STYLE_GAUSSIAN_CURVATURE: u32 = 7;
    pub const STYLE_ISOPHOTES: u32 = 4;
    pub const STYLE_MEAN_CURVATURE: u32 = 6;
    pub const STYLE_NORMALS: u32 = 2;
    pub const STYLE_SHADED: u32 = 0;
    pub const STYLE_TECHNICAL: u32 = 5;
    pub const STYLE_ZEBRA: u32 = 3;
    pub const TAU_HIDDEN: u32 = 0x8000;
    pub const TRIMMED_CORNER_LIST: u32 = 3;
    pub const TRIMMED_LIST: u32 = 1;
}
pub mod seed_list {
    pub const LEAST_PLACES: f32 = 3.0;
    pub const MOST_PLACES: f32 = 32.0;
    pub const SPACING_PX: f32 = 1.0;
}
pub mod segments {
    pub const LINES_PER_SEGMENT: u32 = 32;
    pub const MAX_SEGMENTS: f32 = 65536.0;
}
pub mod shade {
    pub const BLACK: f32 = 0.03;
    pub const FILL_STRENGTH: f32 = 0.34;
    pub const GLOSS: f32 = 0.10;
    pub const GROUND_STRENGTH: f32 = 0.12;
    pub const ISOPHOTE_BANDS: f32 = 18.0;
    pub const KEY_STRENGTH: f32 = 0.86;
    pub const RIM_STRENGTH: f32 = 0.25;
    pub const SHININESS: f32 = 48.0;
    pub const SHOULDER: f32 = 0.76;
    pub const SKY_STRENGTH: f32 = 0.20;
    pub const SUN_FILL_STRENGTH: f32 = 0.20;
    pub const SUN_STRENGTH: f32 = 0.62;
    pub const UNSEEN: f32 = 3.0e38;
    pub const ZEBRA_STRIPES: f32 = 12.0;
}
pub mod solid_change {
    pub const CHANGE_END: u32 = 3;
    pub const CHANGE_FOLD: u32 = 2;
    pub const CHANGE_MEET: u32 = 1;
    pub const CHANGE_NONE: u32 = 0;
    pub const CHANGE_SMOOTH: u32 = 4;
    pub const CHANGE_STEPS: u32 = 9;
    pub const ON_SIDE_PX: f32 = 0.5;
    pub const SAME_SHEET_PX: f32 = 0.5;
    pub const SMOOTH_COSINE: f32 = 0.99984770;
}
pub mod solid_cst {
    pub const OWN: u32 = 0;
    pub const SIDE: u32 = 2;
    pub const WALK: u32 = 1;
}
pub mod solid_events {
    pub const RESUME_BEFORE: u32 = 0x80000000;
}
pub mod solid_layers {
    pub const BOX: f32 = 1e-6;
    pub const ENTERED: u32 = 0x80000000;
    pub const FOR_BACK: u32 = 4;
    pub const FOR_COLOUR: u32 = 0;
    pub const FOR_FIRST: u32 = 1;
    pub const FOR_NTH: u32 = 3;
    pub const FOR_THICKNESS: u32 = 2;
    pub const KEPT: u32 = 12;
    pub const NOBODY: u32 = 0xffffffff;
    pub const OWNER: u32 = 1;
    pub const SEARCH: u32 = 0;
    pub const SIDE: u32 = 2;
}
pub mod solid_rects {
    pub const MARGIN_PX: f32 = 0.5;
}
pub mod solid_sheet {
    pub const NO_LEAF: u32 = 0xffffffff;
    pub const SPLINE_SHEET: u32 = 0xc0000000;
}
pub mod solid_walk {
    pub const KEPT: u32 = 12;
    pub const NO_LEAF: u32 = 0xffffffff;
    pub const OWNER: u32 = 1;
    pub const SEARCH: u32 = 0;
    pub const SIDE: u32 = 2;
}
pub mod solids {
    pub const EXIT_FALSE: u32 = 0xfffffffe;
    pub const EXIT_TRUE: u32 = 0xffffffff;
    pub const LEAF_BOUNDARY: u32 = 8;
    pub const LEAF_CAP: u32 = 128;
    pub const LEAF_ELSEWHERE: u32 = 16;
    pub const LEAF_FALLS: u32 = 4;
    pub const LEAF_FLAG_BITS: u32 = 7;
    pub const LEAF_NEGATIVE: u32 = 2;
    pub const LEAF_PLANES: u32 = 32;
    pub const LEAF_ROUNDS: u32 = 64;
    pub const LEAF_UNBOUNDED: u32 = 1;
    pub const MOST_STEPS: u32 = 30;
    pub const NEVER: f32 = 3.0e38;
    pub const OWN_PLANE: u32 = 0x80000000;
    pub const SETTLED: f32 = 6e-8;
    pub const SIDE_MORE: u32 = 4;
    pub const SIDE_NEGATIVE: u32 = 1;
    pub const SIDE_PLANE: u32 = 2;
    pub const SIDE_SHIFT: u32 = 3;
    pub const SURFACE_PLANE: u32 = 0;
    pub const SURFACE_QUADRIC: u32 = 1;
    pub const SURFACE_TORUS: u32 = 2;
}
pub mod sort {
    pub const FEW: u32 = 16;
}
pub mod split_linked {
    pub const NO_PATCH: u32 = 0xffffffff;
}
pub mod sun {
    pub const CRACK_TRIES: u32 = 7;
    pub const SUN_KEPT: u32 = 12;
}
pub mod table {
    pub const NO_FLIP: f32 = 3.0e38;
}
pub mod tiles {
    pub const BLOCK: u32 = 8;
    pub const LEAF_RUN: u32 = 32768;
    pub const TILE: u32 = 16;
    pub const TILE_LEAF_ENTRY: u32 = 0x80000000;
    pub const TILE_LEAF_GATE: u32 = 0x40000000;
}
pub mod triangle_depth {
    pub const ROUNDING: f32 = 4e-6;
}
pub mod trim {
    pub const TRIM_IN: u32 = 1;
    pub const TRIM_MIXED: u32 = 2;
    pub const TRIM_OUT: u32 = 0;
    pub const TRIM_SAME: u32 = 3;
}
pub mod trimmed_leaf {
    pub const LEAF_OF: u32 = 0x7fffffff;
    pub const UNOWNED: u32 = 0x80000000;
}
pub mod view {
    pub const PIXEL_ROUNDING: f32 = 0.015625;
    pub const RUN: f32 = 16.0;
    pub const SLAB_ROUNDING: f32 = 1e-5;
}
pub mod visibility_corners {
    pub const CORNER_ORDER: u32 = 0xe58;
}
pub mod visibility_trimmed {
    pub const GROWTH: f32 = 0.25;
    pub const STAND_BACK: f32 = 2e-6;
    pub const STEEP: f32 = 4.0;
}
pub mod visible {
    pub const BACK_BEHIND_BORDER: u32 = 0x8000;
    pub const BORDER_BEFORE: u32 = 0x80000000;
    pub const GAP_CANDIDATE: u32 = 0x80000000;
    pub const ISOLATED: u32 = 0x8000;
    pub const SEEN_KIND: u32 = 0x60000000;
    pub const SEEN_MESH: u32 = 0x20000000;
    pub const SEEN_OPERAND: u32 = 0x60000000;
    pub const SEEN_SOLID: u32 = 0x40000000;
    pub const WIDE_BAND_PX: u32 = 16;
}
pub mod volume {
    pub const ON_DEPTH: f32 = 2e-6;
    pub const ON_PX: f32 = 0.01;
}
