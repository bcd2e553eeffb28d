//! The date and the time of the day, for names of files.

const DAY_S: u64 = 86_400;

/// Days from the first of March of year 0 to 1970, and of 400 years.
const DAYS_TO_1970: u64 = 719_468;
const DAYS_OF_ERA: u64 = 146_097;

/// Date and time in UTC of a time since 1970, s, as `20260131-235959`.
#[must_use]
pub fn stamp(since_1970_s: u64) -> String {
    let (year, month, day) = date(since_1970_s / DAY_S);
    let second = since_1970_s % DAY_S;
    let (hour, minute, second) = (second / 3600, second / 60 % 60, second % 60);
    format!("{year:04}{month:02}{day:02}-{hour:02}{minute:02}{second:02}")
}

/// Year, month and day of a day since 1970. Years begin in March here: a leap day is the last of its year.
const fn date(day_since_1970: u64) -> (u64, u64, u64) {
    let day = day_since_1970 + DAYS_TO_1970;
    let (era, day) = (day / DAYS_OF_ERA, day % DAYS_OF_ERA);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, later) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    (400 * era + year + later, month, day)
}

#[cfg(test)]
mod tests {
    use super::stamp;

    #[test]
    fn known_times_have_their_dates() {
        for (time_s, expected) in [
            (0, "19700101-000000"),
            (951_782_399, "20000228-235959"),
            (951_782_400, "20000229-000000"),
            (951_868_800, "20000301-000000"),
            (1_735_689_599, "20241231-235959"),
            (1_735_689_600, "20250101-000000"),
            (4_107_542_400, "21000301-000000"),
        ] {
            assert_eq!(stamp(time_s), expected);
        }
    }
}
