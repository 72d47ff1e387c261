// Work that takes a while, and what is said of it.

export interface JobEvents {
    /// Work that is under way, as a phrase; empty when there is none.
    working: (what: string) => void;
    /// A sentence on what is wrong with a file.
    failed: (sentence: string) => void;
}

/// Work that ends sooner is not mentioned.
const k_noticed_ms = 150;

export class Jobs {
    private count = 0;
    constructor(private readonly events: JobEvents) {}

    get idle(): boolean {
        return this.count === 0;
    }

    /// Runs a task. What goes wrong is told. Whether it went well.
    async run(what: string, task: () => Promise<void>): Promise<boolean> {
        ++this.count;
        const slow = setTimeout(() => this.events.working(what), k_noticed_ms);
        try {
            await task();
            return true;
        } catch (error) {
            this.events.failed((error as Error).message);
            return false;
        } finally {
            clearTimeout(slow);
            if (--this.count === 0) this.events.working('');
        }
    }
}
