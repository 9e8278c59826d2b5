//! Marks in a table that a learning management system exported and imports again: Moodle's grading worksheet,
//! its gradebook, and that of Canvas. Everything but the points stays as it is.

use std::collections::BTreeMap;

use csv::{ReaderBuilder, Terminator, WriterBuilder};
use toyproof_diagnostic::{nearest, spreadsheet_text};

use crate::collect::naming::Student;
use crate::collect::students::{Columns, Students, separator};

/// The column of a table that has only one for points, as Moodle's worksheet.
const ONLY_COLUMN: &str = "grade";
/// The columns, and the first words of a row, with the maximum of points.
const MAXIMUM_COLUMNS: [&str; 2] = ["maximum grade", "maximum mark"];
const MAXIMUM_ROW: &str = "Points Possible";

/// The points of a class, by the names of assignments, which are empty if there is only one.
#[derive(Debug, Default)]
pub struct Marks(BTreeMap<String, Assigned>);

/// The points in an assignment.
#[derive(Debug, Default)]
struct Assigned {
    /// The maximum.
    of: f64,
    points: BTreeMap<Student, f64>,
}

/// A filled table.
#[derive(Debug)]
pub struct Filled {
    /// The table, in UTF-8.
    pub text: String,
    /// How many cells have points.
    pub count: u64,
    /// What the teacher should look at.
    pub warnings: Vec<String>,
}

impl Marks {
    /// Reads `report.csv`. Of several shaders of a student, the one with the fewest points counts.
    ///
    /// # Errors
    /// The table has no points, or no students.
    pub fn parse(text: &str) -> Result<Self, String> {
        let rows = rows(text, b',');
        let header = rows.first().map(Vec::as_slice).unwrap_or_default();
        let column = |name: &str| {
            let at = header.iter().position(|cell| cell == name);
            at.ok_or_else(|| {
                format!("there is no column {name}\nhelp: name the folder that `toyproof check --out` wrote")
            })
        };
        let [student, id, assignment] = [column("student")?, column("id")?, column("assignment")?];
        let [points, of] = [column("points")?, column("max_points")?];
        let mut marks = Self::default();
        let mut has_students = false;
        for row in &rows[1..] {
            let cell = |at: usize| row.get(at).map_or("", |cell| plain(cell));
            if cell(student).is_empty() {
                continue;
            }
            has_students = true;
            let (Ok(points), Ok(of)) = (cell(points).parse::<f64>(), cell(of).parse::<f64>()) else {
                continue;
            };
            let id = Some(cell(id)).filter(|id| !id.is_empty());
            let student = Student {
                name: cell(student).to_owned(),
                id: id.map(str::to_owned),
            };
            let assigned = marks.0.entry(cell(assignment).to_owned()).or_default();
            assigned.of = of;
            let counted = assigned.points.entry(student).or_insert(points);
            *counted = counted.min(points);
        }
        match (has_students, marks.0.is_empty()) {
            (false, _) => Err(
                "no shader has a student\nhelp: collect the submissions with `toyproof collect`, or \
                               check them with --class"
                    .to_owned(),
            ),
            (_, true) => Err(
                "no shader has points\nhelp: check with an assignment that gives points, or with --rubric"
                    .to_owned(),
            ),
            _ => Ok(marks),
        }
    }

    /// Writes the points into a table. Without the name of an assignment, those of all; without the name of
    /// a column, an assignment's column has its name, or is the only one for points.
    ///
    /// # Errors
    /// The assignment, the column or the columns of students are not there.
    pub fn fill(
        &self,
        table: &str,
        assignment: Option<&str>,
        column: Option<&str>,
    ) -> Result<Filled, String> {
        let mut table = Table::parse(table)?;
        let assignments = self.select(assignment)?;
        let mut filled = Filled {
            text: String::new(),
            count: 0,
            warnings: Vec::new(),
        };
        let targets = table.targets(&assignments, column, &mut filled.warnings)?;
        for (assigned, column) in targets {
            table.fill(assigned, column, &mut filled);
        }
        filled.text = table.text();
        Ok(filled)
    }

    /// The assignments to write.
    fn select(&self, name: Option<&str>) -> Result<Vec<(&str, &Assigned)>, String> {
        let all = self.0.iter().map(|(name, assigned)| (name.as_str(), assigned));
        let Some(name) = name else {
            return Ok(all.collect());
        };
        if let Some((known, assigned)) = self.0.get_key_value(name) {
            return Ok(vec![(known, assigned)]);
        }
        let names = self.0.keys().map(String::as_str);
        let help = match nearest(name, names.clone()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the assignments are {}", list(names)),
        };
        Err(format!("the marks have no assignment {name}\nhelp: {help}"))
    }
}

/// A cell without the apostrophe that keeps a spreadsheet from reading a formula.
fn plain(cell: &str) -> &str {
    let text = cell.strip_prefix('\'');
    text.filter(|text| spreadsheet_text(text) == cell).unwrap_or(cell)
}

/// Names in quotes.
fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<_> = names.map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

/// A table of a learning management system.
struct Table {
    separator: u8,
    /// A line `sep=;` of Excel before the table, with its end.
    first_line: String,
    rows: Vec<Vec<String>>,
    students: Students,
    /// The rows of the students.
    places: Vec<usize>,
}

impl Table {
    fn parse(text: &str) -> Result<Self, String> {
        let is_stated = |line: &str| line.to_lowercase().starts_with("sep=");
        let first = text.split_inclusive('\n').next().filter(|line| is_stated(line));
        let first_line = first.unwrap_or_default();
        let text = &text[first_line.len()..];
        let separator = separator(text);
        let rows = rows(text, separator);
        let header = rows
            .first()
            .map(|row| row.iter().map(|cell| cell.trim().to_owned()).collect::<Vec<_>>());
        let columns = header.and_then(|header| Columns::from_header(&header)).ok_or(
            "the first row does not name a column of students\nhelp: export the table again, in English, without changes",
        )?;
        let mut students = Students::default();
        let mut places = Vec::new();
        for (at, row) in rows.iter().enumerate().skip(1) {
            // The row of Canvas with the maximum of points does not belong to a student.
            if row.first().is_some_and(|cell| cell.contains(MAXIMUM_ROW)) {
                continue;
            }
            if students.add(columns.numbers(row), columns.name(row)) {
                places.push(at);
            }
        }
        Ok(Self {
            separator,
            first_line: first_line.to_owned(),
            rows,
            students,
            places,
        })
    }

    /// The columns of assignments.
    fn targets<'a>(
        &self,
        assignments: &[(&str, &'a Assigned)],
        column: Option<&str>,
        warnings: &mut Vec<String>,
    ) -> Result<Vec<(&'a Assigned, usize)>, String> {
        let header = &self.rows[0];
        let columns = || list(header.iter().map(String::as_str));
        let find = |name: &str| header.iter().position(|cell| is_column_of(cell, name));
        if let Some(name) = column {
            let &[(_, assigned)] = assignments else {
                let names = list(assignments.iter().map(|(name, _)| *name));
                return Err(format!(
                    "one column cannot have the points of several assignments\nhelp: choose one with --assignment: {names}"
                ));
            };
            let at = header
                .iter()
                .position(|cell| cell.trim() == name)
                .or_else(|| find(name));
            let at = at.ok_or_else(|| {
                let near = nearest(name, header.iter().map(String::as_str));
                let help = near.map_or_else(
                    || format!("its columns are {}", columns()),
                    |near| format!("did you mean `{near}`?"),
                );
                format!("there is no column {name}\nhelp: {help}")
            })?;
            return Ok(vec![(assigned, at)]);
        }
        let mut targets = Vec::new();
        let mut without = Vec::new();
        for &(name, assigned) in assignments {
            match find(name) {
                Some(at) if !name.is_empty() => targets.push((assigned, at)),
                _ => without.push((name, assigned)),
            }
        }
        if let (&[(_, assigned)], true) = (&without[..], targets.is_empty())
            && let Some(at) = find(ONLY_COLUMN)
        {
            return Ok(vec![(assigned, at)]);
        }
        if targets.is_empty() {
            let help = match (&without[..], find(ONLY_COLUMN)) {
                ([_, _, ..], Some(_)) => format!(
                    "choose the assignment of the table with --assignment: {}",
                    list(without.iter().map(|(name, _)| *name))
                ),
                _ => format!("name its column with --column: {}", columns()),
            };
            return Err(format!("no column has the name of an assignment\nhelp: {help}"));
        }
        warnings.extend(
            without
                .iter()
                .map(|(name, _)| format!("there is no column for {name}")),
        );
        Ok(targets)
    }

    /// Writes the points of an assignment into a column.
    fn fill(&mut self, assigned: &Assigned, column: usize, filled: &mut Filled) {
        self.check_maximum(assigned.of, column, &mut filled.warnings);
        let mut by_row: BTreeMap<usize, Vec<(&Student, f64)>> = BTreeMap::new();
        for (student, &points) in &assigned.points {
            match self.students.place(student) {
                Some(place) => by_row
                    .entry(self.places[place])
                    .or_default()
                    .push((student, points)),
                None => filled.warnings.push(format!(
                    "{} is not in the table, or several students are: enter {points} points by hand",
                    student.described()
                )),
            }
        }
        for (row, found) in by_row {
            if let [(_, points)] = found[..] {
                let row = &mut self.rows[row];
                row.resize(row.len().max(column + 1), String::new());
                row[column] = points.to_string();
                filled.count += 1;
            } else {
                let names: Vec<_> = found.iter().map(|(student, _)| student.described()).collect();
                filled.warnings.push(format!(
                    "{} may be the same student: enter their points by hand",
                    names.join(" and ")
                ));
            }
        }
    }

    /// Warns if the table states another maximum of points than the assignment.
    fn check_maximum(&self, of: f64, column: usize, warnings: &mut Vec<String>) {
        let header = &self.rows[0];
        let beside = header
            .iter()
            .position(|cell| MAXIMUM_COLUMNS.contains(&cell.trim().to_lowercase().as_str()));
        let is_maximum = |row: &&Vec<String>| row.first().is_some_and(|cell| cell.contains(MAXIMUM_ROW));
        let stated = match beside {
            Some(beside) => self.places.first().and_then(|&row| self.rows[row].get(beside)),
            None => self.rows.iter().find(is_maximum).and_then(|row| row.get(column)),
        };
        let stated = stated.and_then(|cell| cell.trim().replace(',', ".").parse::<f64>().ok());
        if let Some(stated) = stated.filter(|&stated| stated != of) {
            warnings.push(format!(
                "{}: the maximum of the table is {stated} points, and the assignment's {of}; points are not converted",
                header[column].trim()
            ));
        }
    }

    /// The table as a text.
    fn text(&self) -> String {
        let mut writer = WriterBuilder::new()
            .delimiter(self.separator)
            .terminator(Terminator::CRLF)
            .flexible(true)
            .from_writer(self.first_line.clone().into_bytes());
        for row in &self.rows {
            writer
                .write_record(row)
                .expect("memory can be written, and rows have any length");
        }
        let bytes = writer.into_inner().expect("memory can be written");
        String::from_utf8(bytes).expect("all cells are texts")
    }
}

/// Whether a column has the points of this assignment: it has its name, perhaps with the number that Canvas
/// adds, or the words of Moodle's gradebook.
fn is_column_of(cell: &str, name: &str) -> bool {
    let (cell, name) = (cell.trim().to_lowercase(), name.trim().to_lowercase());
    let without_number = match cell.strip_suffix(')').and_then(|cell| cell.rsplit_once(" (")) {
        Some((title, number)) if number == "real" || number.bytes().all(|byte| byte.is_ascii_digit()) => {
            title
        }
        _ => &cell,
    };
    let title = without_number
        .strip_prefix("assignment: ")
        .unwrap_or(without_number);
    title.trim() == name || cell == name
}

/// The cells of a table, as they are.
fn rows(text: &str, separator: u8) -> Vec<Vec<String>> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(separator)
        .from_reader(text.as_bytes());
    // The text is UTF-8 and rows may have any length, so no record is an error.
    let records = reader.records().flatten();
    records
        .map(|record| record.iter().map(str::to_owned).collect())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const REPORT: &str = "shader,points,max_points,assignment,student,id\r\n\
        a/a.glsl,10,10,torus,Anna Smith,7\r\n\
        a/b.glsl,9.5,10,torus,Anna Smith,7\r\n\
        b/a.glsl,2.25,10,torus,\"Lee, Bo\",8\r\n\
        c,0,5,objects,'=Mai,\r\n";

    fn fill(
        report: &str,
        table: &str,
        assignment: Option<&str>,
        column: Option<&str>,
    ) -> Result<Filled, String> {
        Marks::parse(report)?.fill(table, assignment, column)
    }

    #[test]
    fn the_worksheet_of_moodle_gets_grades_and_keeps_the_rest() {
        let table = "Identifier,\"Full name\",\"Email address\",Status,Grade,\"Maximum Grade\",\"Last modified (grade)\",\"Feedback comments\"\n\
            \"Participant 7\",\"Anna Smith\",a@x.org,\"Submitted, late\",,10.00,-,\"a \"\"quoted\"\"\nline\"\n\
            \"Participant 9\",\"Bo Lee\",b@x.org,Submitted,3.00,10.00,-,\n\
            \"Participant 10\",\"Cy Dee\",c@x.org,-,,10.00,-,\n";
        let filled = fill(REPORT, table, Some("torus"), None).unwrap();
        assert_eq!(
            filled.text,
            "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Last modified (grade),Feedback comments\r\n\
             Participant 7,Anna Smith,a@x.org,\"Submitted, late\",9.5,10.00,-,\"a \"\"quoted\"\"\nline\"\r\n\
             Participant 9,Bo Lee,b@x.org,Submitted,2.25,10.00,-,\r\n\
             Participant 10,Cy Dee,c@x.org,-,,10.00,-,\r\n"
        );
        assert_eq!(
            (filled.count, filled.warnings.len()),
            (2, 0),
            "{:?}",
            filled.warnings
        );
        let error = fill(REPORT, table, None, None).unwrap_err();
        assert_eq!(
            error,
            "no column has the name of an assignment\n\
             help: choose the assignment of the table with --assignment: `objects`, `torus`"
        );
    }

    #[test]
    fn the_gradebook_of_canvas_has_a_column_for_each_assignment() {
        let table = "Student,ID,SIS User ID,SIS Login ID,Section,Torus (4711),objects (4712)\r\n\
            \"    Points Possible\",,,,,10.00,6.00\r\n\
            \"Smith, Anna\",7,S7,anna,1,,\r\n\
            \"Lee, Bo\",8,S8,bo,1,1,1\r\n\
            =Mai,12,S12,mai,1,,\r\n\
            \"Student, Test\",99,,t,1,,\r\n";
        let filled = fill(REPORT, table, None, None).unwrap();
        assert_eq!(
            filled.text,
            "Student,ID,SIS User ID,SIS Login ID,Section,Torus (4711),objects (4712)\r\n    \
             Points Possible,,,,,10.00,6.00\r\n\
             \"Smith, Anna\",7,S7,anna,1,9.5,\r\n\
             \"Lee, Bo\",8,S8,bo,1,2.25,1\r\n\
             =Mai,12,S12,mai,1,,0\r\n\
             \"Student, Test\",99,,t,1,,\r\n"
        );
        assert_eq!(
            filled.warnings,
            [
                "objects (4712): the maximum of the table is 6 points, and the assignment's 5; points are not converted"
            ]
        );
        assert_eq!(filled.count, 3);
    }

    #[test]
    fn the_gradebook_of_moodle_is_read_with_its_separator() {
        let table =
            "sep=;\nFirst name;Last name;ID number;Assignment: torus (Real)\nAnna;Smith;7;-\nBo;Lee;;-\n";
        let filled = fill(REPORT, table, None, None).unwrap();
        assert_eq!(
            filled.text,
            "sep=;\nFirst name;Last name;ID number;Assignment: torus (Real)\r\nAnna;Smith;7;9.5\r\nBo;Lee;;2.25\r\n"
        );
        assert_eq!(filled.warnings, ["there is no column for objects"]);
    }

    #[test]
    fn students_of_one_name_are_reported_and_not_graded() {
        let table = "Identifier,Full name,Grade\nParticipant 1,Bo Lee,\nParticipant 2,Bo Lee,\n";
        let filled = fill(REPORT, table, Some("torus"), None).unwrap();
        assert_eq!(filled.count, 0);
        assert_eq!(
            filled.warnings,
            [
                "Anna Smith (7) is not in the table, or several students are: enter 9.5 points by hand",
                "Lee, Bo (8) is not in the table, or several students are: enter 2.25 points by hand",
            ]
        );
        let two = "points,max_points,assignment,student,id\n1,2,,Bo Lee,\n2,2,,\"Lee, Bo\",\n";
        let filled = fill(two, "Full name,Grade\nBo Lee,\n", None, None).unwrap();
        assert_eq!(filled.count, 0);
        assert_eq!(
            filled.warnings,
            ["Bo Lee and Lee, Bo may be the same student: enter their points by hand"]
        );
    }

    #[test]
    fn each_error_has_a_way_out() {
        let table = "Full name,Mark\nAnna Smith,\n";
        for (report, table, assignment, column, error) in [
            (
                "a,b\n",
                table,
                None,
                None,
                "there is no column student\nhelp: name the folder that `toyproof check --out` wrote",
            ),
            (
                "points,max_points,assignment,student,id\n1,1,,,\n",
                table,
                None,
                None,
                "no shader has a student\nhelp: collect",
            ),
            (
                "points,max_points,assignment,student,id\n,,,Bo,\n",
                table,
                None,
                None,
                "no shader has points\nhelp: check",
            ),
            (
                REPORT,
                "Name of it,Mark\n",
                None,
                None,
                "the first row does not name a column of students\nhelp: export",
            ),
            (
                REPORT,
                "",
                None,
                None,
                "the first row does not name a column of students",
            ),
            (
                REPORT,
                table,
                Some("tours"),
                None,
                "the marks have no assignment tours\nhelp: did you mean `torus`?",
            ),
            (
                REPORT,
                table,
                Some("torus"),
                Some("Marks"),
                "there is no column Marks\nhelp: did you mean `Mark`?",
            ),
            (
                REPORT,
                table,
                None,
                Some("Mark"),
                "one column cannot have the points of several assignments\nhelp: choose one",
            ),
            (
                REPORT,
                table,
                Some("torus"),
                None,
                "no column has the name of an assignment\nhelp: name its column with --column: `Full name`, `Mark`",
            ),
        ] {
            let found = fill(report, table, assignment, column).unwrap_err();
            assert!(found.starts_with(error), "{found}");
        }
        assert_eq!(fill(REPORT, table, Some("torus"), Some("Mark")).unwrap().count, 1);
    }
}
