# Pages as Doxygen can link them: it knows no headings by the names that Markdown viewers give them, no sources by their paths,
# pictures only by their paths in docs/, and one README.md.
s/\]\(([^)#]*\.md)#[^)]*\)/](\1)/g
s/\[([^]]*)\]\([^)]*\.(hpp|cpp|glsl|json|txt|sh|cmake)\)/\1/g
s/\]\(\.\.\/([^)]*\.(png|svg))\)/](\1)/g
s/\[([^]]*)\]\(docs\/README\.md\)/\1/g
s/\[([^]]*)\]\(#[^)]*\)/\1/g
