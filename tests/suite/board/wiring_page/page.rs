//! The values and the table of broken wires in BOARD.md.

use leg_boards::image::workspace_root;

/// The values of the page, in SI units.
pub struct Page(pub String);

impl Page {
    /// The page of the board.
    pub fn read() -> Self {
        Self(std::fs::read_to_string(workspace_root().join("firmware/BOARD.md")).unwrap())
    }

    /// The value of a name: it stands in one table alone.
    pub fn value(&self, name: &str) -> f64 {
        let start = format!("| {name} |");
        let rows: Vec<&str> = self
            .0
            .lines()
            .filter(|row| row.starts_with(&start))
            .collect();
        let [row] = rows.as_slice() else {
            panic!("{name} stands in {} rows", rows.len());
        };
        let text = row.split('|').nth(2).unwrap().trim().replace('−', "-");
        let (number, unit) = text.split_once(' ').unwrap();
        let scale = match unit {
            "Ω" | "V" | "A" | "N" | "V/V" | "lines" | "steps" => 1.0,
            "kΩ" | "kHz" => 1e3,
            "MΩ" => 1e6,
            "mΩ" | "mV/V" | "mV/K" => 1e-3,
            "%" => 1e-2,
            "µF" | "µV" | "µV/K" => 1e-6,
            "nF" => 1e-9,
            "pF" => 1e-12,
            _ => panic!("{name}: {unit}"),
        };
        number.parse::<f64>().unwrap() * scale
    }

    /// The values of some names.
    pub fn values<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.value(name))
    }

    /// The table of broken wires.
    pub fn broken_rows(&self) -> impl Iterator<Item = &str> {
        let (_, table) = self
            .0
            .split_once("| broken | volts at the pin | found as |")
            .unwrap();
        table.lines().skip(2).take_while(|row| row.starts_with('|'))
    }

    /// What the table of broken wires says of one: volts, and what it is found as.
    pub fn broken(&self, wire: &str) -> [&str; 2] {
        let start = format!("| {wire} |");
        let row = self
            .broken_rows()
            .find(|row| row.starts_with(&start))
            .unwrap();
        let mut cells = row.split('|').skip(2).map(str::trim);
        [cells.next().unwrap(), cells.next().unwrap()]
    }
}
