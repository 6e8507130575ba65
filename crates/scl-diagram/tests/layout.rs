//! What holds for every layout, tried with random diagrams.

use proptest::prelude::*;
use scl_diagram::{Block, Diagram, Edge, End, Frame, Layout, Point, Rectangle, Row};

/// What a random diagram is made of: for each frame a number that chooses its parent, for each block one that chooses
/// its frame and its number of rows, and for each edge those of its ends.
fn diagrams() -> impl Strategy<Value = Diagram> {
    let numbers = |most: usize| prop::collection::vec(any::<u32>(), 0..most);
    let edges = prop::collection::vec((any::<u32>(), any::<u32>(), any::<u32>(), any::<u32>()), 0..60);
    (numbers(5), prop::collection::vec((any::<u32>(), 0_usize..6), 1..24), edges).prop_map(|(frames, blocks, edges)| {
        let frames = frames.iter().enumerate().map(|(index, &chosen)| {
            let parent = chosen as usize % (index + 1);
            Frame { title: format!("frame {index}"), parent: parent.checked_sub(1) }
        });
        let frames: Vec<Frame> = frames.collect();
        let blocks = blocks.iter().enumerate().map(|(index, &(frame, rows))| {
            let name = format!("block_{index}");
            let row = |row| Row { name: format!("gate_{row}"), kind: "pub".into(), types: "T".into(), figures: None };
            let rows = (0..rows).map(row);
            let frame = (frame as usize % (frames.len() + 1)).checked_sub(1);
            Block { title: name.clone(), name, others: Vec::new(), rows: rows.collect(), frame, state: None }
        });
        let blocks: Vec<Block> = blocks.collect();
        let end = |block: u32, row: u32| {
            let block = block as usize % blocks.len();
            let rows = blocks[block].rows.len();
            End { block, row: (rows > 0).then(|| row as usize % rows.max(1)) }
        };
        let edges = edges.iter().map(|&(from, from_row, to, to_row)| {
            let (from, to) = (end(from, from_row), end(to, to_row));
            let (details, connections) = (Vec::new(), Vec::new());
            Edge { from, to, both_ways: false, asks: false, details, connections, flow: None }
        });
        let edges = edges.collect();
        Diagram { title: "random".into(), frames, blocks, edges, notes: Vec::new() }
    })
}

fn overlap(one: &Rectangle, other: &Rectangle) -> bool {
    one.x < other.x + other.width
        && other.x < one.x + one.width
        && one.y < other.y + other.height
        && other.y < one.y + one.height
}

fn contains(outer: &Rectangle, inner: &Rectangle) -> bool {
    outer.x <= inner.x
        && outer.y <= inner.y
        && inner.x + inner.width <= outer.x + outer.width
        && inner.y + inner.height <= outer.y + outer.height
}

/// Whether a point is at the left or right edge of a rectangle, not at a corner.
fn is_at_side(area: &Rectangle, point: &Point) -> bool {
    (point.x == area.x || point.x == area.x + area.width) && area.y < point.y && point.y < area.y + area.height
}

fn frames_around(diagram: &Diagram, innermost: Option<usize>) -> Vec<usize> {
    std::iter::successors(innermost, |&frame| diagram.frames[frame].parent).collect()
}

proptest! {
    #[test]
    fn blocks_and_frames_overlap_only_what_they_are_in(diagram in diagrams()) {
        let layout = Layout::of(&diagram);
        for (index, block) in layout.blocks.iter().enumerate() {
            let picture = Rectangle { x: 0.0, y: 0.0, width: layout.width, height: layout.height };
            prop_assert!(contains(&picture, &block.area));
            for other in &layout.blocks[index + 1..] {
                prop_assert!(!overlap(&block.area, &other.area));
            }
            let around = frames_around(&diagram, diagram.blocks[index].frame);
            for (frame, area) in layout.frames.iter().enumerate() {
                if around.contains(&frame) {
                    prop_assert!(contains(area, &block.area), "block {index} in frame {frame}");
                } else {
                    prop_assert!(!overlap(area, &block.area), "block {index} beside frame {frame}");
                }
            }
        }
    }

    #[test]
    fn each_edge_leads_from_a_side_of_its_first_block_to_one_of_its_second(diagram in diagrams()) {
        let layout = Layout::of(&diagram);
        for (edge, points) in diagram.edges.iter().zip(&layout.edges) {
            let ends = [(edge.from, points.first()), (edge.to, points.last())];
            for (end, point) in ends {
                let placed = &layout.blocks[end.block];
                let point = point.expect("an edge has points");
                prop_assert!(is_at_side(&placed.area, point), "{end:?} {point:?} {:?}", placed.area);
                if let (Some(row), true) = (end.row, edge.from.block != edge.to.block) {
                    let rank = placed.rows.iter().position(|&it| it == row).expect("each row has a place");
                    let expected = placed.area.y + 26.0 + 20.0 * (rank as f64 + 0.5);
                    prop_assert!((point.y - expected).abs() < 0.01);
                }
            }
        }
    }

    /// Between two points an edge is between two layers, or passes a layer in a straight line.
    #[test]
    fn no_edge_passes_through_a_block(diagram in diagrams()) {
        let layout = Layout::of(&diagram);
        for points in &layout.edges {
            for pair in points.windows(2) {
                let (left, right) = (pair[0].x.min(pair[1].x), pair[0].x.max(pair[1].x));
                let (top, bottom) = (pair[0].y.min(pair[1].y), pair[0].y.max(pair[1].y));
                let passed = Rectangle { x: left, y: top, width: right - left, height: bottom - top };
                for block in &layout.blocks {
                    prop_assert!(!overlap(&passed, &block.area), "{passed:?} {:?}", block.area);
                }
            }
        }
    }

    #[test]
    fn a_diagram_has_the_same_layout_each_time(diagram in diagrams()) {
        prop_assert_eq!(Layout::of(&diagram), Layout::of(&diagram));
    }
}
