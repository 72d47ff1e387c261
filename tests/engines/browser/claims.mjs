// Counts what a suite of tests claims, and prints a line for each.

export class Claims {
    passed = 0;
    failed = 0;
    skipped = 0;

    /// Counts a claim. `wrong` lists what contradicts it; `measured` is printed if the claim holds.
    claim = (what, wrong, measured = '') => {
        if (wrong.length) {
            ++this.failed;
            console.log(`FAILED: ${what}: ${wrong.join('; ')}`);
        } else {
            ++this.passed;
            console.log(`passed: ${what}${measured ? ` (${measured})` : ''}`);
        }
    };

    skip = what => {
        ++this.skipped;
        console.log(`skipped: ${what}`);
    };
}
