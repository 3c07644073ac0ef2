//! Static condensation and the harmonics of a ring against dense algebra and against one factorisation of the ring.

use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use gearmesh_fe::{
    CondensedLoads, CyclicInterface, CylindricalFrames, DofMap, Element, Factor, FeError, FeModel,
    Material, Ring, RingCondensation, StaticCondensation, StructuredMesh, assemble_stiffness,
    numbers_without_pattern,
};

fn close(a: &Mat<f64>, b: &Mat<f64>, tolerance: f64) -> bool {
    let scale = b.norm_max();
    (a - b).norm_max() < tolerance * scale
}

/// y_I of all loads over the whole interior.
fn interior(part: &StaticCondensation, loads: &CondensedLoads) -> Mat<f64> {
    let mut y = Mat::zeros(part.interior_size(), loads.kept.ncols());
    for load in 0..loads.kept.ncols() {
        loads.put_interior(load, y.col_mut(load));
    }
    y
}

fn steel(mesh: StructuredMesh) -> FeModel {
    let material = Material::new(210e9, 0.3).unwrap();
    FeModel::new(mesh.nodes, mesh.hexes, material, Element::Hex8Incompatible).unwrap()
}

/// A floating block: S, the carried loads, work inside and the interior, against dense elimination.
#[test]
fn condensation_is_block_elimination() {
    let model = steel(StructuredMesh::block([5, 4, 3], [0.05, 0.03, 0.04]));
    let kept: Vec<usize> = (0..model.node_count())
        .rev()
        .filter(|&n| model.nodes()[n][0] == 0.0 || model.nodes()[n][0] == 0.05)
        .collect();
    let dofs = DofMap::all_free(model.node_count()).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    let dense = k.to_dense();
    let part = StaticCondensation::new(k, &kept).unwrap();

    let of =
        |nodes: &[usize]| -> Vec<usize> { nodes.iter().flat_map(|n| 3 * n..3 * n + 3).collect() };
    let inner: Vec<usize> = (0..model.node_count())
        .filter(|n| !kept.contains(n))
        .collect();
    let (i, b) = (of(&inner), of(&kept));
    let block =
        |r: &[usize], c: &[usize]| Mat::from_fn(r.len(), c.len(), |x, y| dense[(r[x], c[y])]);
    let k_ii = block(&i, &i).llt(Side::Lower).unwrap();
    let (k_ib, k_bi) = (block(&i, &b), block(&b, &i));
    let s = block(&b, &b) - &k_bi * k_ii.solve(&k_ib);
    assert!(close(&part.stiffness().to_owned(), &s, 1e-13));
    // It floats: moving all kept nodes alike costs nothing.
    let shift = Mat::from_fn(b.len(), 1, |row, _| f64::from(row % 3 == 1));
    assert!((part.stiffness() * &shift).norm_max() < 1e-12 * s.norm_max());

    let loads = numbers_without_pattern(dense.nrows(), 3);
    let rows = |r: &[usize]| Mat::from_fn(r.len(), 3, |x, y| loads[(r[x], y)]);
    let (p_i, p_b) = (rows(&i), rows(&b));
    let held = k_ii.solve(&p_i);
    let condensed = part.condense(loads.as_ref());
    assert!(close(&condensed.kept, &(p_b - &k_bi * &held), 1e-12));
    assert!(close(
        &condensed.gram(&condensed),
        &(p_i.transpose() * &held),
        1e-12
    ));

    // A load at one node alone reaches few rows, with the same results.
    let mut single = Mat::<f64>::zeros(dense.nrows(), 1);
    single[(3 * inner[0] + 1, 0)] = 2.0;
    let single_condensed = part.condense(single.as_ref());
    let held_single = k_ii.solve(Mat::from_fn(i.len(), 1, |x, _| single[(i[x], 0)]));
    let work = condensed.gram(&single_condensed);
    assert!(close(&work, &(p_i.transpose() * &held_single), 1e-12));

    let inside = interior(&part, &condensed);
    let u_b = numbers_without_pattern(b.len(), 3);
    let full = part.expand(u_b.as_ref(), Some(inside.as_ref()));
    let u_i = held - k_ii.solve(&k_ib * &u_b);
    let taken = |r: &[usize]| Mat::from_fn(r.len(), 3, |x, y| full[(r[x], y)]);
    assert!(close(&taken(&b), &u_b, 1e-12));
    // Displacements prescribed (of order 1) swamp those of the loads: compared on their own too.
    assert!(close(&taken(&i), &u_i, 1e-12));
    let zero = Mat::<f64>::zeros(b.len(), 3);
    let loaded = part.expand(zero.as_ref(), Some(inside.as_ref()));
    let loaded = Mat::from_fn(i.len(), 3, |x, y| loaded[(i[x], y)]);
    assert!(close(&loaded, &k_ii.solve(&p_i), 1e-12));
}

/// In cylindrical components a part and its turned image have one stiffness, and it is Qᵀ K Q.
#[test]
fn turned_parts_have_one_stiffness_in_cylindrical_components() {
    let stiffness = |angle: f64| {
        let (s, c) = angle.sin_cos();
        let model = steel(StructuredMesh::mapped([2, 3, 2], |[x, y, z]| {
            let (x, y) = (0.05 + 0.02 * x + 0.004 * y * z, 0.03 * y);
            [c * x - s * y, s * x + c * y, 0.01 * z]
        }));
        let mut k =
            assemble_stiffness(&model, &DofMap::all_free(model.node_count()).unwrap()).unwrap();
        let cartesian = k.to_dense();
        let frames = CylindricalFrames::new(model.nodes().iter().copied());
        frames.turn_stiffness(&mut k);
        (frames, cartesian, k.to_dense())
    };
    let (frames, cartesian, here) = stiffness(0.0);
    let (_, _, there) = stiffness(1.234);
    assert!(close(&here, &there, 1e-13));
    // u'ᵀ K' u' = uᵀ K u for any field.
    let n = here.nrows();
    let turned = numbers_without_pattern(n, 2);
    let mut u = Mat::zeros(n, 2);
    for node in 0..n / 3 {
        for column in 0..2 {
            let part = std::array::from_fn(|a| turned[(3 * node + a, column)]);
            let plain = frames.to_cartesian(node, part);
            let back = frames.to_cylindrical(node, plain);
            for a in 0..3 {
                u[(3 * node + a, column)] = plain[a];
                assert!((back[a] - part[a]).abs() < 1e-15);
            }
        }
    }
    let energy = |k: &Mat<f64>, u: &Mat<f64>| u.transpose() * (k * u);
    assert!(close(
        &energy(&here, &turned),
        &energy(&cartesian, &u),
        1e-13
    ));
}

/// Harmonics against the circulant matrix of all cuts, for even, odd and the smallest numbers of sectors.
#[test]
fn harmonics_solve_the_circulant_system() {
    let cut = 7;
    let root = numbers_without_pattern(2 * cut, 2 * cut);
    let s = &root * root.transpose() + Mat::<f64>::identity(2 * cut, 2 * cut) * 0.1;
    for sectors in [2, 3, 4, 7] {
        let ring = CyclicInterface::new(s.as_ref(), sectors).unwrap();
        assert_eq!(ring.harmonics(), sectors / 2 + 1);
        let row = |sector: usize, i: usize| ((sector + i / cut) % sectors) * cut + i % cut;
        let mut whole = Mat::<f64>::zeros(sectors * cut, sectors * cut);
        for sector in 0..sectors {
            for i in 0..2 * cut {
                for j in 0..2 * cut {
                    whole[(row(sector, i), row(sector, j))] += s[(i, j)];
                }
            }
        }
        let inverse = whole.llt(Side::Lower).unwrap();
        let loads: Vec<Mat<f64>> = (0..sectors)
            .map(|sector| {
                numbers_without_pattern(2 * cut + sector, 4)
                    .subrows(sector, 2 * cut)
                    .to_owned()
            })
            .collect();
        let gathered = |block: &Mat<f64>, sector: usize| {
            let mut f = Mat::<f64>::zeros(sectors * cut, block.ncols());
            for i in 0..2 * cut {
                for c in 0..block.ncols() {
                    f[(row(sector, i), c)] += block[(i, c)];
                }
            }
            f
        };
        let mut force = Mat::<f64>::zeros(sectors * cut, 4);
        for (sector, block) in loads.iter().enumerate() {
            force += gathered(block, sector);
        }
        let u = inverse.solve(&force);
        for (sector, found) in ring.displacements(&loads).iter().enumerate() {
            let expected = Mat::from_fn(2 * cut, 4, |i, c| u[(row(sector, i), c)]);
            assert!(close(found, &expected, 1e-12), "{sectors} sectors");
        }
        let first = inverse.solve(gathered(&loads[0], 0));
        for (offset, found) in ring.products(loads[0].as_ref()).iter().enumerate() {
            let expected = gathered(&loads[0], offset).transpose() * &first;
            assert!(
                close(found, &expected, 1e-12),
                "{sectors} sectors, offset {offset}"
            );
        }
    }
}

/// A finite element ring held at its inside, a sector of four element columns: against the factor of the whole ring.
#[test]
fn a_ring_of_elements_by_sectors_and_as_a_whole() {
    let (sectors, columns) = (6, 4);
    let ring = |counts| StructuredMesh::ring(counts, [0.03, 0.05], 0.02);
    let whole = steel(ring([sectors * columns, 3, 2]));
    let held: Vec<usize> = (0..whole.node_count())
        .filter(|&n| whole.nodes()[n][0].hypot(whole.nodes()[n][1]) < 0.03 + 1e-9)
        .collect();
    let dofs = DofMap::with_fixed_nodes(whole.node_count(), &held).unwrap();
    let k = assemble_stiffness(&whole, &dofs).unwrap();
    let factor = Factor::of_model(&whole, &dofs, &k).unwrap();
    // The load: one newton outwards at the outside, one column into the sector (the ring runs clockwise).
    let place = |step: usize| {
        let angle = -std::f64::consts::TAU * step as f64 / (sectors * columns) as f64;
        [0.05 * angle.cos(), 0.05 * angle.sin(), 0.01]
    };
    let near = |nodes: &[[f64; 3]], p: [f64; 3]| {
        nodes
            .iter()
            .position(|q| (0..3).all(|a| (q[a] - p[a]).abs() < 1e-9))
    };
    let loaded = near(whole.nodes(), place(1)).unwrap();
    let frames = CylindricalFrames::new(whole.nodes().iter().copied());
    let mut u = vec![0.0; dofs.free_count()];
    for (axis, part) in frames
        .to_cartesian(loaded, [1.0, 0.0, 0.0])
        .into_iter()
        .enumerate()
    {
        u[dofs.free_of(3 * loaded + axis).unwrap()] = part;
    }
    factor.solve_slice_in_place(&mut u);
    let u = dofs.expand(&u);

    // One sector on its own: the elements of the first four columns.
    let angle_of = |p: [f64; 3]| (-p[1].atan2(p[0])).rem_euclid(std::f64::consts::TAU);
    let width = std::f64::consts::TAU / sectors as f64;
    let columns: Vec<u32> = (0..whole.element_count())
        .filter(|&e| {
            let c = whole.element_coordinates(e).unwrap();
            let mean = [0, 1].map(|a| c.iter().map(|p| p[a]).sum::<f64>());
            angle_of([mean[0], mean[1], 0.0]) < width
        })
        .map(|e| e as u32)
        .collect();
    let (nodes, sector) = whole.part(&columns).unwrap();
    let free: Vec<u32> = nodes
        .iter()
        .copied()
        .filter(|n| !held.contains(&(*n as usize)))
        .collect();
    let held_here: Vec<usize> = held
        .iter()
        .filter_map(|&n| nodes.binary_search(&(n as u32)).ok())
        .collect();
    let here = DofMap::with_fixed_nodes(nodes.len(), &held_here).unwrap();
    let mut stiffness = assemble_stiffness(&sector, &here).unwrap();
    CylindricalFrames::new(free.iter().map(|&n| whole.nodes()[n as usize]))
        .turn_stiffness(&mut stiffness);
    let at =
        |p: [f64; 3]| near(whole.nodes(), p).and_then(|n| free.binary_search(&(n as u32)).ok());
    let turned = |p: [f64; 3], step: usize| {
        let (s, c) = (-width * step as f64).sin_cos();
        [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]]
    };
    let cut: Vec<usize> = (0..free.len())
        .filter(|&i| angle_of(whole.nodes()[free[i] as usize]).min(1.0) < 1e-9)
        .collect();
    let image = cut
        .iter()
        .map(|&i| at(turned(whole.nodes()[free[i] as usize], 1)).unwrap());
    let kept: Vec<usize> = cut.iter().copied().chain(image).collect();
    let part = StaticCondensation::new(stiffness, &kept).unwrap();
    let ring = CyclicInterface::new(part.stiffness(), sectors).unwrap();
    let mut load = Mat::<f64>::zeros(part.size(), 1);
    load[(3 * at(place(1)).unwrap(), 0)] = 1.0;
    let condensed = part.condense(load.as_ref());
    let inside = interior(&part, &condensed);
    let mut at_cuts = vec![Mat::<f64>::zeros(2 * 3 * cut.len(), 1); sectors];
    at_cuts[0].copy_from(&condensed.kept);
    let largest = u.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    for (j, cuts) in ring.displacements(&at_cuts).iter().enumerate() {
        let found = part.expand(cuts.as_ref(), (j == 0).then_some(inside.as_ref()));
        for (i, &node) in free.iter().enumerate() {
            let there = near(whole.nodes(), turned(whole.nodes()[node as usize], j)).unwrap();
            let expected =
                frames.to_cylindrical(there, [u[3 * there], u[3 * there + 1], u[3 * there + 2]]);
            for (axis, value) in expected.into_iter().enumerate() {
                assert!((found[(3 * i + axis, 0)] - value).abs() < 1e-11 * largest);
            }
        }
    }
    let own =
        condensed.gram(&condensed)[(0, 0)] + ring.products(condensed.kept.as_ref())[0][(0, 0)];
    let direct = frames.to_cylindrical(
        loaded,
        [u[3 * loaded], u[3 * loaded + 1], u[3 * loaded + 2]],
    )[0];
    assert!((own - direct).abs() < 1e-11 * direct);
}

/// A bar held at one end, loads at the other, whose nodes are eliminated last: what is before them is not looked at.
#[test]
fn half_solves_begin_where_the_loads_are() {
    let mesh = StructuredMesh::block([2, 2, 12], [1.0, 1.0, 6.0]);
    let held = mesh.nodes_where(|x| x[2] == 0.0);
    let end = mesh.nodes_where(|x| x[2] == 6.0);
    let model = steel(mesh);
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held).unwrap();
    let k = assemble_stiffness(&model, &dofs).unwrap();
    // Held nodes are the first ones.
    let late: Vec<usize> = end.iter().map(|node| node - held.len()).collect();
    let bar = StaticCondensation::announced(k, &late, &[], |_| ()).unwrap();
    let at_end = numbers_without_pattern(3 * late.len(), 4);
    let mut everywhere = Mat::zeros(bar.size(), 4);
    for (i, node) in late.iter().enumerate() {
        let mut rows = everywhere.as_mut().subrows_mut(3 * node, 3);
        rows.copy_from(at_end.subrows(3 * i, 3));
    }
    let some = bar.condense_at(|row| 3 * late[row / 3] + row % 3, at_end.as_ref());
    let all = bar.condense(everywhere.as_ref());
    assert_eq!(some.gram(&some), all.gram(&all));
    let u = bar.expand(
        Mat::zeros(0, 4).as_ref(),
        Some(interior(&bar, &some).as_ref()),
    );
    let work = everywhere.transpose() * &u;
    assert!(close(&some.gram(&some), &work, 1e-10));
    let rows = some.interior_rows();
    assert!((27..120).contains(&rows), "{rows} of {}", bar.size());
}

/// Parts with any stiffness in a ring round a core that does not repeat, against one dense matrix: solutions, work of
/// any two loads, and the way of loads on one part. Two nodes of a part are the ring's, two the core's; those of both
/// kinds at its left are the next part's.
#[test]
fn a_ring_round_a_core_is_solved_by_harmonics() {
    for parts in [4, 5] {
        let definite = |size: usize, seed: usize| {
            let a = numbers_without_pattern(size, size + seed);
            let mut s = &a * a.transpose();
            for i in 0..size {
                s[(i, i)] += 0.1 * size as f64;
            }
            s
        };
        // Numbers in no order: the ring's own are odd.
        let ring = |part: usize, i: usize| 2 * (2 * (part % parts) + i) + 1;
        let circle = |part: usize, i: usize| 2 * (2 * (part % parts) + i);
        let nodes: Vec<Vec<usize>> = (0..parts)
            .map(|p| {
                let own = [circle(p, 1), ring(p, 0), circle(p, 0), ring(p, 1)];
                let next = [ring(p + 1, 1), circle(p + 1, 0), ring(p + 1, 0)];
                own.into_iter().chain(next).collect()
            })
            .collect();
        let count = 4 * parts + 3;
        let inside = 4 * parts..count;
        let core_nodes: Vec<usize> = (0..4 * parts).step_by(2).chain(inside).collect();
        let (of_part, of_core) = (definite(21, 0), definite(3 * core_nodes.len(), 1));
        let mut dense = Mat::<f64>::zeros(3 * count, 3 * count);
        let mut add = |block: &Mat<f64>, nodes: &[usize]| {
            for i in 0..block.nrows() {
                for j in 0..block.ncols() {
                    dense[(3 * nodes[i / 3] + i % 3, 3 * nodes[j / 3] + j % 3)] += block[(i, j)];
                }
            }
        };
        nodes.iter().for_each(|list| add(&of_part, list));
        add(&of_core, &core_nodes);
        let k = dense.llt(Side::Lower).unwrap();

        let ring = Ring::new(of_part.as_ref(), &nodes, |node| {
            core_nodes.binary_search(&node).is_ok()
        })
        .unwrap();
        assert_eq!(ring.harmonics(), parts / 2 + 1);
        let circle: Vec<usize> = (ring.core_nodes())
            .map(|node| core_nodes.binary_search(&node).unwrap())
            .collect();
        let mut with_ring = of_core.clone();
        let blocks = ring.stiffness_at_core();
        let own = blocks[0].nrows();
        for i in 0..parts * own {
            for j in 0..parts * own {
                let row = 3 * circle[i / 3] + i % 3;
                let column = 3 * circle[j / 3] + j % 3;
                let apart = (i / own + parts - j / own) % parts;
                with_ring[(row, column)] += blocks[apart][(i % own, j % own)];
            }
        }
        let lower: Vec<Triplet<usize, usize, f64>> = (0..with_ring.ncols())
            .flat_map(|j| (j..with_ring.nrows()).map(move |i| (i, j)))
            .map(|(i, j)| Triplet::new(i, j, with_ring[(i, j)]))
            .collect();
        let size = with_ring.nrows();
        let lower = SparseColMat::try_new_from_triplets(size, size, &lower).unwrap();
        let core = StaticCondensation::announced(lower, &circle, &[], |_| ()).unwrap();
        let body = RingCondensation::new(ring, core, core_nodes).unwrap();

        let loads = numbers_without_pattern(3 * count, 3);
        let u = k.solve(&loads);
        let halves = body.condense(loads.as_ref());
        let work = loads.transpose() * &u;
        assert!(close(&halves.gram(&halves), &work, 1e-12));
        let mut rows = Mat::zeros(body.interior_size(), 3);
        for load in 0..3 {
            halves.put_interior(load, rows.col_mut(load));
        }
        assert!(close(&body.expand(rows.as_ref()), &u, 1e-12));

        // The same loads on one part and on another one.
        let on_part = numbers_without_pattern(21, 2);
        let placed = |part: usize| {
            let mut loads = Mat::<f64>::zeros(3 * count, 2);
            for i in 0..21 {
                for j in 0..2 {
                    loads[(3 * nodes[part][i / 3] + i % 3, j)] += on_part[(i, j)];
                }
            }
            loads
        };
        let carried = body.ring().carry(on_part.as_ref());
        let in_ring = body.ring().work(&carried);
        for (a, b) in [(0, 0), (1, 0), (0, 1), (3, 1), (1, 3)] {
            let halves = [a, b].map(|part| body.condense_at_core(carried.at_core(), part));
            let found = halves[0].gram(&halves[1]) + &in_ring[(a + parts - b) % parts];
            let expected = placed(a).transpose() * k.solve(placed(b));
            assert!(close(&found, &expected, 1e-12), "{parts}: {a} {b}");
        }
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let model = steel(StructuredMesh::block([2, 2, 2], [1.0; 3]));
    let k = || assemble_stiffness(&model, &DofMap::all_free(27).unwrap()).unwrap();
    for kept in [vec![3, 3], vec![27]] {
        let index = kept[0];
        assert_eq!(
            StaticCondensation::new(k(), &kept).unwrap_err(),
            FeError::NotAPermutation { index, size: 27 }
        );
    }
    // One kept node does not hold the rest against turning.
    assert!(matches!(
        StaticCondensation::new(k(), &[0]),
        Err(FeError::NotPositiveDefinite { .. })
    ));
    let s = Mat::<f64>::identity(4, 4);
    assert!(matches!(
        CyclicInterface::new(s.as_ref(), 1),
        Err(FeError::SizeMismatch { expected: 0, .. })
    ));
    assert!(CyclicInterface::new(s.as_ref().subrows(0, 3), 5).is_err());
    let minus = Mat::<f64>::identity(4, 4) * -1.0;
    assert!(matches!(
        CyclicInterface::new(minus.as_ref(), 5),
        Err(FeError::NotPositiveDefinite { .. })
    ));
}
