//! The list of a class's students: which rows there are, and who a student of a download is.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use csv::{ReaderBuilder, Trim};
use unicode_normalization::UnicodeNormalization;

use super::naming::Student;

/// The listed students of a class.
#[derive(Debug, Clone, Default)]
pub struct Students {
    listed: Vec<Student>,
    /// The places in the list of the students with a number or a name, in the form of [`key`].
    places: HashMap<String, Vec<usize>>,
}

impl Students {
    /// Reads a table as spreadsheets and learning management systems write it (RFC 4180, also with `;` or
    /// tabs). Without a row that names the columns, the first column has the number or the name of the
    /// download, and the second the name to show.
    pub fn parse(text: &str) -> Self {
        // Excel may state the separator in a separate line.
        let text = match text.split_once('\n') {
            Some((first, rest)) if first.to_lowercase().starts_with("sep=") => rest,
            _ => text,
        };
        let mut rows: Vec<Vec<String>> = rows(text, separator(text));
        rows.retain(|row| row.iter().any(|cell| !cell.is_empty()));
        let columns = rows.first().and_then(|row| Columns::from_header(row));
        let skipped = usize::from(columns.is_some());
        let mut students = Self::default();
        for row in rows.iter().skip(skipped) {
            if let Some(columns) = &columns {
                students.add(columns.numbers(row), columns.name(row));
            } else {
                let name = row.get(1).cloned().unwrap_or_default();
                students.add(vec![row[0].clone()], name);
            }
        }
        students
    }

    /// The students with these names or numbers in the download, each with the name to show, which may be
    /// empty.
    pub fn new(list: Vec<(String, String)>) -> Self {
        let mut students = Self::default();
        for (key, name) in list {
            students.add(vec![key], name);
        }
        students
    }

    /// Adds a student; returns false for one without a name or a number. `keys` are all numbers or names in
    /// downloads, and the first is shown; `name` is the name to show.
    pub(crate) fn add(&mut self, mut keys: Vec<String>, mut name: String) -> bool {
        keys.retain(|key| !key.is_empty());
        let mut id = keys.first().cloned();
        if name.is_empty() {
            let Some(only) = id.take() else {
                return false;
            };
            name = only;
        }
        let place = self.listed.len();
        let known: BTreeSet<String> = keys
            .into_iter()
            .map(|one| key(&one))
            .chain(name_keys(&name))
            .collect();
        for known in known {
            self.places.entry(known).or_default().push(place);
        }
        self.listed.push(Student { name, id });
        true
    }

    /// The place in the list of the only student with this number, or else with this name.
    pub(crate) fn place(&self, student: &Student) -> Option<usize> {
        let number = student.id.as_deref().map(key);
        let keys = number.into_iter().chain(name_keys(&student.name));
        let mut places = keys.filter_map(|key| self.places.get(&key));
        let only = places.find_map(|places| <[usize; 1]>::try_from(&places[..]).ok());
        only.map(|[place]| place)
    }

    /// The listed students.
    pub fn all(&self) -> &[Student] {
        &self.listed
    }

    /// Finds the students of a download in the list, by number or else by name; also returns the places in
    /// the list that are found. Where the download or the list has several students with one name, their
    /// numbers in the download distinguish them.
    pub fn find<'a>(
        &self,
        students: impl IntoIterator<Item = &'a Student>,
    ) -> (HashMap<&'a Student, Student>, HashSet<usize>) {
        let mut found = HashMap::new();
        let mut places_found = HashSet::new();
        let mut by_name: BTreeMap<&[usize], Vec<&Student>> = BTreeMap::new();
        for student in students.into_iter().collect::<BTreeSet<_>>() {
            let number = student.id.as_ref().and_then(|id| self.places.get(&key(id)));
            if let Some(&[place]) = number.map(Vec::as_slice) {
                found.insert(student, self.listed[place].clone());
                places_found.insert(place);
            } else if let Some(places) = self.places.get(&key(&student.name)) {
                by_name.entry(places).or_default().push(student);
            }
        }
        for (places, students) in by_name {
            let is_sure = places.len() == 1 && students.len() == 1;
            if students.len() >= places.len() {
                places_found.extend(places);
            }
            for student in students {
                let listed = self.listed[places[0]].clone();
                let id = if is_sure { listed.id } else { student.id.clone() };
                found.insert(student, Student { id, ..listed });
            }
        }
        (found, places_found)
    }
}

/// The columns of a table of students.
pub(crate) struct Columns {
    numbers: Vec<usize>,
    name: Option<usize>,
    given_name: Option<usize>,
    surname: Option<usize>,
}

impl Columns {
    /// The columns that a row names; `None` if it names no student's name.
    pub(crate) fn from_header(row: &[String]) -> Option<Self> {
        let names: Vec<String> = row.iter().map(|cell| cell.to_lowercase()).collect();
        let first = |known: &[&str]| names.iter().position(|name| known.contains(&name.as_str()));
        let is_number = |name: &str| {
            matches!(
                name,
                "id" | "identifier"
                    | "number"
                    | "id number"
                    | "student id"
                    | "student number"
                    | "sis user id"
                    | "sis login id"
                    | "username"
                    | "matriculation number"
            )
        };
        let columns = Self {
            numbers: (0..names.len()).filter(|&at| is_number(&names[at])).collect(),
            name: first(&["full name", "name", "student", "student name"]),
            given_name: first(&["first name", "given name"]),
            surname: first(&["last name", "surname", "family name"]),
        };
        let has_name = columns.name.is_some() || columns.given_name.is_some() && columns.surname.is_some();
        has_name.then_some(columns)
    }

    pub(crate) fn numbers(&self, row: &[String]) -> Vec<String> {
        let cells = self.numbers.iter().filter_map(|&at| row.get(at));
        // Moodle writes `Participant 1234`, and 1234 into the names of folders.
        cells
            .map(|cell| cell.strip_prefix("Participant ").unwrap_or(cell).to_owned())
            .collect()
    }

    pub(crate) fn name(&self, row: &[String]) -> String {
        let cell = |at: Option<usize>| at.and_then(|at| row.get(at)).map_or("", String::as_str);
        match cell(self.name) {
            "" => format!("{} {}", cell(self.given_name), cell(self.surname))
                .trim()
                .to_owned(),
            name => name.to_owned(),
        }
    }
}

/// The cells of a table, with single spaces instead of line ends and other white space.
fn rows(text: &str, separator: u8) -> Vec<Vec<String>> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .delimiter(separator)
        .from_reader(text.as_bytes());
    let cell = |cell: &str| cell.split_whitespace().collect::<Vec<_>>().join(" ");
    // The text is UTF-8 and rows may have any length, so no record is an error.
    let records = reader.records().flatten();
    records.map(|record| record.iter().map(cell).collect()).collect()
}

/// The separator of a table: the one that is in all rows, else the one that is in most of them.
pub(crate) fn separator(text: &str) -> u8 {
    let several = |separator: &u8| {
        let rows = rows(text, *separator);
        rows.iter().filter(|row| row.len() > 1).count()
    };
    // Of equal ones the last: names may have commas.
    let by_rows = [b',', b';', b'\t'].into_iter().max_by_key(several);
    by_rows.unwrap_or(b',')
}

/// A number or a name without differences that do not distinguish students: case, and the encoding of letters
/// with accents.
fn key(text: &str) -> String {
    text.trim().nfc().collect::<String>().to_lowercase()
}

/// The names of a student in downloads: `Smith, Anna` and `Anna Smith` for Moodle, and `smithanna`
/// for Canvas.
fn name_keys(name: &str) -> Vec<String> {
    let name = key(name);
    let (given, surname) = match name.split_once(',') {
        Some((surname, given)) => (given.trim(), surname.trim()),
        None => name.rsplit_once(' ').unwrap_or(("", &name)),
    };
    let letters = |text: &str| {
        text.chars()
            .filter(|letter| letter.is_alphanumeric())
            .collect::<String>()
    };
    let mut keys = vec![letters(surname) + &letters(given), format!("{given} {surname}")];
    keys.push(name);
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    fn student(name: &str, id: &str) -> Student {
        Student {
            name: name.to_owned(),
            id: (!id.is_empty()).then(|| id.to_owned()),
        }
    }

    fn listed(text: &str) -> Vec<(String, String)> {
        let students = Students::parse(text).listed.into_iter();
        students
            .map(|student| (student.name, student.id.unwrap_or_default()))
            .collect()
    }

    #[test]
    fn tables_are_read_as_spreadsheets_and_systems_write_them() {
        let both =
            [("Smith, Anna", "1"), ("O\"Neil; Bo", "2")].map(|(name, id)| (name.to_owned(), id.to_owned()));
        for text in [
            "1,\"Smith, Anna\"\n2,\"O\"\"Neil; Bo\"\n",
            "1;Smith, Anna\r\n2;\"O\"\"Neil; Bo\"",
            "1\tSmith, Anna\n\n2\tO\"Neil; Bo\n",
            "sep=;\r\n1;\"Smith, Anna\"\r\n2;\"O\"\"Neil; Bo\"\r\n",
            " 1 ,\"Smith,\n Anna\" \n2,\"O\"\"Neil; Bo\"\n",
            "Identifier,Full name,Grade\nParticipant 1,\"Smith, Anna\",\nParticipant 2,\"O\"\"Neil; Bo\",3\n",
            "Student;ID;Section\n\"Smith, Anna\";1;a\n\"O\"\"Neil; Bo\";2;a\n",
        ] {
            assert_eq!(listed(text), both, "{text}");
        }
        let joined = listed("Surname,First name,ID number\n\"van Dam, Jr.\",Bo,7\n");
        assert_eq!(joined, [("Bo van Dam, Jr.".to_owned(), "7".to_owned())]);
        assert_eq!(
            listed("Anna Smith\n\"Lee, Bo\"\n"),
            [
                ("Anna Smith".to_owned(), String::new()),
                ("Lee, Bo".to_owned(), String::new())
            ]
        );
    }

    #[test]
    fn students_are_found_by_number_or_name() {
        let students = Students::parse("12,Anna Smith\n13,Bo\nmai\n14,\"Müller, Zoë\"\n");
        assert_eq!(students.all().len(), 4);
        let find = |name: &str, id: &str| {
            let one = student(name, id);
            students.find([&one]).0.get(&one).cloned()
        };
        assert_eq!(find("whoever", "12"), Some(student("Anna Smith", "12")));
        assert_eq!(find("smithanna", "99"), Some(student("Anna Smith", "12")));
        assert_eq!(find("BO", ""), Some(student("Bo", "13")));
        assert_eq!(find("Mai", "99"), Some(student("mai", "")));
        assert_eq!(
            find("Zoe\u{308} Mu\u{308}ller", "5"),
            Some(student("Müller, Zoë", "14"))
        );
        assert_eq!(find("other", ""), None);
    }

    #[test]
    fn students_with_one_name_remain_several() {
        let students = Students::parse("1,Anna Smith\n2,Anna Smith\n3,Bo Lee\n");
        let download = [
            student("Anna Smith", "77"),
            student("Anna Smith", "78"),
            student("Bo Lee", "79"),
            student("Bo Lee", "80"),
        ];
        let (found, places) = students.find(&download);
        for (at, one) in download.iter().enumerate() {
            assert_eq!(found[one], *one, "{at}");
        }
        assert_eq!(places, HashSet::from([0, 1, 2]));
        // It is unknown which of the two listed ones it is.
        let (found, places) = students.find(&download[..1]);
        assert_eq!((&found[&download[0]], places.len()), (&download[0], 0));
        // Numbers of the list do distinguish them.
        let second = student("Anna Smith", "2");
        let (found, places) = students.find([&second]);
        assert_eq!(
            found.into_values().collect::<Vec<_>>(),
            [student("Anna Smith", "2")]
        );
        assert_eq!(places, HashSet::from([1]));
    }
}
