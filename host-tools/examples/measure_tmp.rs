use leg_host_tools::{check, link::InProcess, precision::TABLE};
fn main() {
    let n: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let t = std::time::Instant::now();
    let mut s = check::grid();
    s.extend(check::random(n, 7));
    println!("sampled {:?}", t.elapsed());
    let mut l = InProcess::open().unwrap();
    let r = check::run(&mut l, &TABLE, &s, || {}).unwrap();
    println!("{:?}", t.elapsed());
    for row in &r.rows {
        println!(
            "{:30} {:9.2e} {:9.2e} {} {}",
            row.row.name,
            row.worst,
            row.row.bound,
            row.at.unwrap(),
            row.held
        );
    }
    println!("{:?}", r.bits);
}
