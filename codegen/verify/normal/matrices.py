"""Determinants of square matrices of forms, and of what else can be added and multiplied."""


def determinant(matrix):
    """Determinant of a square matrix of forms, by expansion; each minor of the last rows is made once."""
    known = {}

    def minor(row, columns):
        if not columns:
            return 1
        if columns not in known:
            total = matrix[0][0] * 0
            for k, column in enumerate(columns):
                if entry := matrix[row][column]:
                    total += entry * minor(row + 1, columns[:k] + columns[k + 1:]) * (-1) ** k
            known[columns] = total
        return known[columns]

    return minor(0, tuple(range(len(matrix))))


def minors(matrix):
    """Leading principal minors; all are positive exactly where the matrix is positive definite."""
    return [determinant([row[:k] for row in matrix[:k]]) for k in range(1, len(matrix) + 1)]
