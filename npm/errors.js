/// What the library, or this package, refuses: a sentence, the option it is about, and what to do.
export class DomelightError extends Error {
    constructor(what, field = '', hint = '') {
        super(`${field && !/^`/.test(field) ? `${field}: ` : field && `${field} `}${what}${/[.!?]$/.test(what) ? '' : '.'}${hint && ` ${hint}`}`);
        this.name = 'DomelightError';
        /// The option that is wrong, in the words of the options ("irradianceSize"), or the name of the file; empty: neither.
        this.field = field.replace(/`/g, '');
        this.what = what;
        this.hint = hint;
    }

    /// The same error in another thread.
    toJSON() {
        return {what: this.what, field: this.field, hint: this.hint};
    }
}

/// The library's words for options, in JavaScript's form: `irradiance_size` is irradianceSize here.
export const camelCase = text => text.replace(/`[a-z_0-9]+`/g, name => name.replace(/_([a-z])/g, (_, letter) => letter.toUpperCase()));

export const aborted = signal => signal?.reason ?? new DOMException('The work was aborted.', 'AbortError');
