//! The engine: job, rounds of work units, threads, merge, stop rules.
