//! What the graph of the nodes predicts is what the analysis of the whole pattern does.

mod support;

use frontal::{NodeGraph, Options, Pattern, Prediction, Symbolic};

/// A grid of nodes with `k` unknowns each: its pattern, and its graph of nodes.
fn grid(cells: [usize; 3], k: usize) -> (Pattern, NodeGraph) {
    let matrix = support::grid(cells, k, 7);
    let pattern = matrix.pattern.clone().with_block(k).unwrap();
    let nodes = pattern.len() / k;
    let mut graph = NodeGraph { starts: vec![0], neighbours: Vec::new(), weights: vec![k as u32; nodes] };
    for node in 0..nodes {
        let row = &pattern.columns()[pattern.starts()[k * node]..pattern.starts()[k * node + 1]];
        let mut others: Vec<u32> = row.iter().map(|column| (column / k) as u32).collect();
        others.dedup();
        graph.neighbours.extend(others.into_iter().filter(|&other| other as usize != node));
        graph.starts.push(graph.neighbours.len());
    }
    (pattern, graph)
}

#[test]
fn nodes_predict_what_the_analysis_finds() {
    for (cells, k) in [([9, 8, 7], 3), ([40, 30, 1], 2), ([12, 1, 1], 1)] {
        let (pattern, graph) = grid(cells, k);
        assert_eq!(graph.nonzeros(), pattern.nonzeros());
        let analysed = Symbolic::analyse(&pattern, &Options::default()).unwrap();
        let analysed = [false, true].map(|symmetric| analysed.for_values(symmetric).unwrap().prediction());
        assert_eq!(Prediction::of_nodes(graph, &[], &Options::default(), 1).unwrap(), analysed, "{cells:?}");
    }
}

/// More threads need more working memory and the same factor; a node that couples to many may come last.
#[test]
fn threads_and_last_nodes_are_heeded() {
    let (pattern, graph) = grid([16, 16, 16], 3);
    let mut options = Options::default();
    let of = |last: &[usize], threads: usize| Prediction::of_nodes(graph.clone(), last, &Options::default(), threads);
    let ([one, _], [four, _]) = (of(&[], 1).unwrap(), of(&[], 4).unwrap());
    assert!(four.bytes >= one.bytes && four.factor_entries == one.factor_entries);
    options.last = vec![300];
    assert_eq!(of(&[100], 1).unwrap()[0], Symbolic::analyse(&pattern, &options).unwrap().prediction());
    assert!(of(&[1 << 20], 1).is_err());
}

#[test]
fn the_speed_of_the_machine_is_measured() {
    let speed = frontal::speed().unwrap();
    assert!(speed > 1e7 && speed < 1e13, "{speed:.1e}");
}
