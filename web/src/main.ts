// The page is on the screen before its program runs, which takes a moment.

requestAnimationFrame(() => setTimeout(() => void import('./start')));
