# Pages as Doxygen can link them: it knows no headings by the names that Markdown viewers give them, and no headers by their paths.
s/\]\(([^)#]*\.md)#[^)]*\)/](\1)/g
s/\[([^]]*)\]\([^)]*\.hpp\)/\1/g
