//! `engine-run JOB`: does one job and prints its reading, each as a line of JSON; `engine-run --built` names the engines.

use std::process::ExitCode;

fn main() -> ExitCode {
    let argument = std::env::args().nth(1).unwrap_or_default();
    if argument == "--built" {
        let names = carom_bench::built();
        println!("{}", serde_json::to_string(&names).unwrap_or_default());
        return ExitCode::SUCCESS;
    }
    let job = match serde_json::from_str(&argument) {
        Ok(job) => job,
        Err(error) => {
            eprintln!("error: {argument:?} is no job: {error}");
            return ExitCode::from(2);
        }
    };
    let reading = carom_bench::run(&job);
    println!("{}", serde_json::to_string(&reading).unwrap_or_default());
    ExitCode::SUCCESS
}
