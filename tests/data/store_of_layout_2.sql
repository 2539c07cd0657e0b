-- A store as layout 2 wrote it: its tables, and one run.

PRAGMA journal_mode = WAL;
BEGIN;
CREATE TABLE experiments (
        id INTEGER PRIMARY KEY,
        digest TEXT NOT NULL UNIQUE,
        content TEXT NOT NULL,
        algorithm TEXT NOT NULL,
        maze TEXT NOT NULL
    );
CREATE TABLE batches (
        id INTEGER PRIMARY KEY,
        experiment INTEGER NOT NULL REFERENCES experiments,
        version TEXT NOT NULL,
        "commit" TEXT,
        python TEXT NOT NULL,
        numpy TEXT NOT NULL,
        numba TEXT NOT NULL,
        platform TEXT NOT NULL,
        time TEXT NOT NULL
    );
CREATE TABLE runs (
        experiment INTEGER NOT NULL REFERENCES experiments,
        run INTEGER NOT NULL,
        batch INTEGER NOT NULL REFERENCES batches,
        success INTEGER NOT NULL,
        generation INTEGER NOT NULL,
        distance INTEGER NOT NULL,
        controller TEXT NOT NULL,
        coefficients TEXT NOT NULL,
        evaluations INTEGER NOT NULL,
        seconds REAL NOT NULL,
        checksum TEXT NOT NULL,
        PRIMARY KEY (experiment, run)
    ) WITHOUT ROWID;
INSERT INTO experiments VALUES (
    1, 'a4bbadc1c78966d28872dbe60ff40cb9c996f884e228ed4a08eb7d6c3a24f4b8', '{"seed": 1}', 'safe', 'maze1'
);
INSERT INTO batches VALUES (1, 1, '0.1.0', NULL, '3.11.7', '2.4.3', '0.67.0', 'Linux', '2026-01-01T00:00:00+00:00');
INSERT INTO runs VALUES (
    1, 7, 1, 1, 141, 2, '[0.1, -1e-300, 0.3333333333333333]', '[0.85, 0.99]', 28400, 0.25, '2a64fc6d5ba882c3'
);
PRAGMA application_id = 0x53414645;
PRAGMA user_version = 2;
COMMIT;
